#include "relief/session.h"

#include <algorithm>
#include <optional>
#include <ostream>
#include <utility>
#include <vector>

#include "api/instance_mattes.h"
#include "api/make_engine.h"
#include "api/moving_picture.h"
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
    SessionCounts counts;
    std::unique_ptr<Film> film; ///< the last picture; null: none that the engine could update
    bool is_lost = false;       ///< a change of the scene has failed

    Implementation(Scene scene, const RenderSettings& given, SessionUse session_use)
        : layers(given.image.layers), use(session_use) {
        validate_settings(given);
        settings = complete_settings(given, has_shadow_catchers(scene));
        validate_method(settings, scene.camera);
        const Timer timer;
        mattes = make_instance_mattes(scene, settings.image.layers);
        with_threads(settings.device.threads, [&] {
            editor = std::make_unique<SceneEditor>(std::move(scene), settings, use);
            start_engine();
        });
        prepare_s = timer.seconds();
    }

    void start_engine() {
        film.reset(), engine.reset(); // so that a device does not hold two
        counts = {};
        engine = make_engine(editor->scene(), settings);
        if (use == SessionUse::edits) engine->expect_changes();
    }

    /// One that could not be made, or was lost, is made again.
    void need_engine() {
        if (!engine) start_engine();
    }

    /// Retraces what changed since the last picture and keeps the rest.
    bool trace_picture(const PictureSpace& space, RenderObserver* observer) {
        need_engine();
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

    /// Those of a picture to come.
    RenderSettings check_image(const ImageSettings& image, const Camera& camera) const {
        if (image.layers != layers)
            throw Error(ErrorKind::usage,
                        {"a session keeps its layers", "image.layers", "begin another session"});
        RenderSettings changed = settings;
        changed.image = image;
        validate_settings(changed);
        validate_camera(camera);
        validate_method(changed, camera);
        return complete_settings(changed, editor->scene()->has_shadow_catchers);
    }

    void change_view(const Camera& camera, const ImageSettings& image, uint64_t scene_hash) {
        const Timer timer;
        const RenderSettings changed = check_image(image, camera);
        need_engine();
        settings = changed;
        film.reset();
        if (!engine->change_view(editor->change_view(camera, settings, scene_hash), settings.image))
            start_engine();
        prepare_s += timer.seconds();
    }

    void change_scene(SceneUpdate update, const ImageSettings& image) {
        check_use();
        const Timer timer;
        settings = check_image(image, update.camera);
        film.reset();
        if (update.scene) mattes = make_instance_mattes(*update.scene, settings.image.layers);
        if (!move(std::move(update), settings.image)) start_engine();
        prepare_s += timer.seconds();
    }

    void check_use() const {
        if (use != SessionUse::scenes)
            throw Error(ErrorKind::usage,
                        {"the session is not one whose scene changes", "session", "SessionUse::scenes"});
        if (is_lost)
            throw Error(ErrorKind::usage, {"an error has ended the session", "session", "begin another"});
    }

    /// Puts the scene at another time in place. False: the engine does not follow.
    bool move(SceneUpdate update, const ImageSettings& image) {
        need_engine();
        RenderSettings changed = settings;
        changed.image = image;
        if (!update.scene)
            return engine->change_view(editor->change_view(update.camera, changed, update.scene_hash), image);
        is_lost = true;
        update.scene->hash = update.scene_hash;
        const std::optional<std::vector<SurfaceChange>> changes =
            editor->change_scene(std::move(*update.scene), changed);
        is_lost = false;
        return changes && engine->change_scene(*changes, image);
    }

    /// The same in the middle of a picture.
    void move_sample(SceneUpdate update, const ImageSettings& image) {
        if (move(std::move(update), image)) return;
        keep_counts(*engine, counts);
        engine.reset(); // so that a device does not hold two
        RenderSettings changed = settings;
        changed.image = image;
        engine = make_engine(editor->scene(), changed);
    }

    template <class Trace> RenderResult show(RenderObserver* observer, const Trace& trace);

    bool trace_moving(double frame, const UpdateScene& update, const PictureSpace& space,
                      RenderObserver* observer, const Checkpoints& checkpoints);

    EditReport apply(const MapEdit& edit) {
        if (use == SessionUse::scenes)
            throw Error(ErrorKind::usage, {"maps of a session for scenes take no edits", "session",
                                           "SessionUse::edits or views"});
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

bool Session::Implementation::trace_moving(double frame, const UpdateScene& update, const PictureSpace& space,
                                           RenderObserver* observer, const Checkpoints& checkpoints) {
    const uint64_t scene_hash = editor->scene_hash();
    const Camera camera = editor->scene()->camera;
    const std::string identity = describe_samples(settings, scene_hash);
    film = std::make_unique<Film>(make_film(settings.image, mattes));
    if (checkpoints.resume) film->read(*checkpoints.resume, identity);
    RenderControl control(observer);
    control.save.interval_s = checkpoints.interval_s;
    if (checkpoints.save)
        control.save.call = [&] {
            if (film->most_samples() > 0)
                checkpoints.save([&](std::ostream& stream) { film->write(stream, identity); });
        };
    show_pictures(*film, space, control);
    const MovingStage stage{
        [&](int sample, const ImageSettings& image) {
            move_sample(update(find_sample_time(camera, frame, sample)), image);
        },
        [&](Film& target, const RenderControl& part) { return engine->render(target, part); }};
    try {
        const bool is_complete = render_samples(*film, settings.image, control, stage);
        if (control.save.call) control.save.call();
        return is_complete;
    } catch (...) {
        if (control.save.call) control.save.call(); // samples are added whole
        throw;
    }
}

double find_sample_time(const Camera& camera, double frame, int sample) {
    const uint32_t bits = 0x80000000u + uint32_t(sample) * 0x9e3779b9u; // of the golden ratio's fraction
    const double share = double(bits) * 0x1p-32;
    const double open = camera.shutter_open, close = camera.shutter_close;
    return frame + open + (close - open) * share;
}

Session::Session(Scene scene, const RenderSettings& settings, SessionUse use)
    : implementation_(std::make_unique<Implementation>(std::move(scene), settings, use)) {}

Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

/// Times `trace` and makes a picture of the film; `trace` returns whether that is complete.
template <class Trace>
RenderResult Session::Implementation::show(RenderObserver* observer, const Trace& trace) {
    RenderResult result;
    Statistics& statistics = result.statistics;
    const Timer total;
    with_threads(settings.device.threads, [&] {
        if (observer) observer->on_warnings(editor->scene()->warnings);
        const Timer timer;
        const PictureSpace space = make_picture_space(*editor->scene());
        const uint64_t scene_hash = editor->scene_hash();
        result.is_complete = trace(space);
        statistics.render_s = timer.seconds();
        statistics.prepare_s = std::exchange(prepare_s, 0);
        collect_statistics(*engine, *film, *editor->scene(), statistics, counts);
        result.whole_samples = int(film->least_samples());
        result.image = film->resolve(space);
        add_metadata(settings, scene_hash, result.is_complete, *film, result.image);
    });
    statistics.total_s = statistics.prepare_s + total.seconds();
    statistics.peak_resident_bytes = peak_resident_bytes();
    return result;
}

RenderResult Session::render(RenderObserver* observer) {
    return implementation_->show(
        observer, [&](const PictureSpace& space) { return implementation_->trace_picture(space, observer); });
}

RenderResult Session::render_moving(double frame, const UpdateScene& update, RenderObserver* observer,
                                    const Checkpoints& checkpoints) {
    implementation_->check_use();
    RenderResult result = implementation_->show(observer, [&](const PictureSpace& space) {
        return implementation_->trace_moving(frame, update, space, observer, checkpoints);
    });
    implementation_->film.reset(); // of no time that a picture could go on with
    return result;
}

void Session::change_scene(SceneUpdate update, const ImageSettings& image) {
    with_threads(implementation_->settings.device.threads,
                 [&] { implementation_->change_scene(std::move(update), image); });
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
