#include "relief/session.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "api/instance_mattes.h"
#include "api/make_engine.h"
#include "api/picture_report.h"
#include "base/machine.h"
#include "base/parallel.h"
#include "base/timer.h"
#include "prepare/scene_edit.h"
#include "prepare/validate_settings.h"
#include "relief/error.h"

namespace relief {

struct Session::Implementation {
    RenderSettings settings;
    std::vector<std::string> layers; ///< as the caller gave them
    SessionUse use;
    double prepare_s = 0; ///< since the last picture
    std::shared_ptr<const InstanceMattes> mattes;
    std::unique_ptr<SceneEditor> editor;
    std::unique_ptr<Engine> engine;
    Statistics counted;         ///< by the engine, for the pictures so far
    std::unique_ptr<Film> film; ///< the last picture; null: none that the engine could update

    Implementation(Scene scene, const RenderSettings& given, SessionUse session_use)
        : layers(given.image.layers), use(session_use) {
        validate_settings(given);
        settings = complete_settings(given, has_shadow_catchers(scene));
        validate_method(settings, scene.camera);
        const Timer timer;
        mattes = make_instance_mattes(scene, settings.image.layers);
        with_threads(settings.device.threads, [&] {
            editor = std::make_unique<SceneEditor>(std::move(scene), settings);
            start_engine();
        });
        prepare_s = timer.seconds();
    }

    void start_engine() {
        film.reset(), engine.reset(); // so that a device does not hold two
        counted = {};
        engine = make_engine(editor->scene(), settings);
        if (use == SessionUse::edits) engine->expect_changes();
    }

    /// One that could not be made, or was lost, is made again.
    void need_engine() {
        if (!engine) start_engine();
    }

    /// Retraces what changed since the last picture and keeps the rest.
    bool trace_picture(RenderObserver* observer) {
        need_engine();
        const PictureSpace space = make_picture_space(*editor->scene());
        RenderControl control(observer);
        if (film) {
            show_pictures(*film, space, control);
            return engine->refresh(*film, control);
        }
        auto fresh = std::make_unique<Film>(make_film(settings.image, mattes));
        show_pictures(*fresh, space, control);
        const bool is_complete = engine->render(*fresh, control);
        film = std::move(fresh);
        return is_complete;
    }

    void change_view(const Camera& camera, const ImageSettings& image, uint64_t scene_hash) {
        const Timer timer;
        if (image.layers != layers)
            throw Error(ErrorKind::usage,
                        {"a session keeps its layers", "image.layers", "begin another session"});
        RenderSettings changed = settings;
        changed.image = image;
        validate_settings(changed);
        validate_camera(camera);
        validate_method(changed, camera);
        changed = complete_settings(changed, editor->scene()->has_shadow_catchers);
        need_engine();
        settings = changed;
        film.reset();
        if (!engine->change_view(editor->change_view(camera, settings, scene_hash), settings.image))
            start_engine();
        prepare_s += timer.seconds();
    }

    EditReport apply(const MapEdit& edit) {
        const Timer timer;
        const CheckedEdit checked = editor->check(edit);
        need_engine();
        // If anything fails from here on, the next picture is rendered from scratch.
        std::unique_ptr<Film> kept = std::move(film);
        const bool was_enclosed = editor->scene()->may_enclose_camera;
        const std::vector<SurfaceChange> changes = editor->apply(checked);
        // All bounce rays see other levels once the camera comes to be in a body.
        if (editor->scene()->may_enclose_camera == was_enclosed && engine->apply_changes(changes))
            film = std::move(kept);
        else
            start_engine();
        EditReport report;
        for (const SurfaceChange& change : changes)
            report.patches += uint64_t(std::count(change.is_changed.begin(), change.is_changed.end(), 1));
        report.seconds = timer.seconds();
        prepare_s += report.seconds;
        return report;
    }
};

Session::Session(Scene scene, const RenderSettings& settings, SessionUse use)
    : implementation_(std::make_unique<Implementation>(std::move(scene), settings, use)) {}

Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

RenderResult Session::render(RenderObserver* observer) {
    Implementation& self = *implementation_;
    RenderResult result;
    Statistics& statistics = result.statistics;
    const Timer total;
    with_threads(self.settings.device.threads, [&] {
        if (observer) observer->on_warnings(self.editor->scene()->warnings);
        const Timer timer;
        result.is_complete = self.trace_picture(observer);
        statistics.render_s = timer.seconds();
        statistics.prepare_s = std::exchange(self.prepare_s, 0);
        collect_statistics(*self.engine, *self.film, *self.editor->scene(), statistics, self.counted);
        result.whole_samples = int(self.film->least_samples());
        result.image = self.film->resolve(make_picture_space(*self.editor->scene()));
        add_metadata(self.settings, self.editor->scene_hash(), result.is_complete, *self.film, result.image);
    });
    statistics.total_s = statistics.prepare_s + total.seconds();
    statistics.peak_resident_bytes = peak_resident_bytes();
    return result;
}

EditReport Session::edit(const MapEdit& edit) {
    EditReport report;
    with_threads(implementation_->settings.device.threads, [&] { report = implementation_->apply(edit); });
    return report;
}

void Session::change_view(const Camera& camera, const ImageSettings& image, uint64_t scene_hash) {
    with_threads(implementation_->settings.device.threads,
                 [&] { implementation_->change_view(camera, image, scene_hash); });
}

bool Session::is_far_away() const { return implementation_->editor->scene()->has_far_objects; }

void Session::check(const MapEdit& edit) const {
    with_threads(implementation_->settings.device.threads, [&] { implementation_->editor->check(edit); });
}

} // namespace relief
