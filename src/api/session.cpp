#include "relief/session.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "api/instance_mattes.h"
#include "api/join_parts.h"
#include "api/make_engine.h"
#include "api/motion_vectors.h"
#include "api/moving_picture.h"
#include "api/picture_report.h"
#include "api/prepare_scope.h"
#include "base/machine.h"
#include "base/parallel.h"
#include "base/stop_request.h"
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
    /// What the scene waits for after a change that failed or was cancelled.
    enum class Missing { nothing, view, scene } missing = Missing::nothing;

    Implementation(Scene scene, const RenderSettings& given, SessionUse session_use, RenderObserver* observer)
        : layers(given.image.layers), use(session_use) {
        validate_settings(given);
        settings = complete_settings(given, has_shadow_catchers(scene));
        validate_method(settings, scene.camera);
        const Timer timer;
        mattes = make_instance_mattes(scene, settings.image.layers);
        prepare(observer, [&] {
            editor = std::make_unique<SceneEditor>(std::move(scene), settings, use);
            start_engine();
        });
        prepare_s = timer.seconds();
    }

    /// On the session's threads.
    template <class Work> void prepare(RenderObserver* observer, const Work& work) {
        const PrepareScope scope(observer);
        try {
            with_threads(settings.device.threads, work);
        } catch (const StopRequest&) {
            film.reset(), engine.reset();
            throw Error(ErrorKind::failed, {"the preparation of the scene was cancelled", "session", ""});
        }
    }

    void start_engine() {
        film.reset(), engine.reset(); // so that a device does not hold two
        counts = {};
        engine = make_engine(editor->scene(), settings);
        if (use == SessionUse::edits) engine->expect_changes();
    }

    /// The scene has changed; where the observer cancels now, the next picture has to wait for the engine.
    void restart_engine() {
        try {
            start_engine();
        } catch (const StopRequest&) {
            engine.reset();
        }
    }

    /// Whether the engine follows a change; one that was cancelled on the way is let go.
    template <class Change> bool follow(const Change& change) {
        try {
            return engine && change();
        } catch (const StopRequest&) {
            engine.reset();
            return false;
        }
    }

    /// One that could not be made, or was lost, is made again.
    void need_engine() {
        if (missing != Missing::nothing)
            throw Error(ErrorKind::usage,
                        {"the last change of the scene has failed", "session",
                         missing == Missing::view ? "call change_view() or change_scene()"
                                                  : "call change_scene() with a whole scene"});
        if (!engine) start_engine();
    }

    /// Retraces what changed since the last picture and keeps the rest.
    bool trace_picture(const PictureSpace& space, RenderObserver* observer) {
        RenderControl control(observer);
        control.spent_s = prepare_s;
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
    RenderSettings check_image(const ImageSettings& image, const Camera& camera, bool has_catchers) const {
        if (image.layers != layers)
            throw Error(ErrorKind::usage,
                        {"a session keeps its layers", "image.layers", "begin another session"});
        RenderSettings changed = settings;
        changed.image = image;
        validate_settings(changed);
        validate_camera(camera);
        validate_method(changed, camera);
        return complete_settings(changed, has_catchers);
    }

    void change_view(const Camera& camera, const ImageSettings& image, uint64_t scene_hash) {
        const Timer timer;
        const RenderSettings changed = check_image(image, camera, editor->scene()->has_shadow_catchers);
        if (missing != Missing::view) need_engine();
        settings = changed;
        film.reset();
        if (!move_view(camera, settings, scene_hash)) restart_engine();
        prepare_s += timer.seconds();
    }

    /// False: there is no engine that follows.
    bool move_view(const Camera& camera, const RenderSettings& changed, uint64_t scene_hash) {
        const Missing before = std::exchange(missing, Missing::view);
        const std::vector<SurfaceChange> changes = editor->change_view(camera, changed, scene_hash);
        missing = Missing::nothing;
        return before == Missing::nothing && follow([&] { return show_changes(changes, changed.image); });
    }

    bool show_changes(const std::vector<SurfaceChange>& changes, const ImageSettings& image) {
        const bool is_replaced = std::ranges::any_of(changes, &SurfaceChange::is_replaced);
        return is_replaced ? engine->change_scene(changes, image) : engine->change_view(changes, image);
    }

    void change_scene(SceneUpdate update, const ImageSettings& image) {
        check_use();
        const Timer timer;
        settings = check_image(image, update.camera,
                               update.scene ? has_shadow_catchers(*update.scene)
                                            : editor->scene()->has_shadow_catchers);
        film.reset();
        if (update.scene) mattes = make_instance_mattes(*update.scene, settings.image.layers);
        if (!move(std::move(update), settings.image)) restart_engine();
        prepare_s += timer.seconds();
    }

    void check_use() const {
        if (use != SessionUse::scenes)
            throw Error(ErrorKind::usage,
                        {"the session is not one whose scene changes", "session", "SessionUse::scenes"});
    }

    /// Puts the scene at another time in place. False: there is no engine that follows.
    bool move(SceneUpdate update, const ImageSettings& image) {
        RenderSettings changed = settings;
        changed.image = image;
        if (!update.scene) {
            if (missing == Missing::scene) need_engine();
            return move_view(update.camera, changed, update.scene_hash);
        }
        if (missing != Missing::nothing) engine.reset();
        missing = Missing::scene;
        update.scene->hash = update.scene_hash;
        const std::optional<std::vector<SurfaceChange>> changes =
            editor->change_scene(std::move(*update.scene), changed);
        missing = Missing::nothing;
        return changes && follow([&] { return engine->change_scene(*changes, image); });
    }

    /// One picture names each object once.
    void check_objects(const Scene& scene) const {
        const auto refuse = [](const char* what) {
            throw Error(ErrorKind::bad_input,
                        {std::string(what) + " while the shutter is open", "objects",
                         "let them change between two frames, or set camera.shutter to [0, 0]"});
        };
        const PreparedScene& before = *editor->scene();
        if (scene.objects.size() != before.instances.size()) refuse("objects come or go");
        for (size_t k = 0; k < scene.objects.size(); ++k)
            if (scene.objects[k].is_shadow_catcher != before.instances[k].is_shadow_catcher)
                refuse("an object becomes a shadow catcher, or is one no longer,");
        const auto others = make_instance_mattes(scene, settings.image.layers);
        if (others && (others->objects != mattes->objects || others->materials != mattes->materials))
            refuse("with layers of Cryptomatte, objects change their names or materials");
    }

    /// The scene at another time of the same picture.
    void move_sample(double time, const UpdateScene& update_scene, const ImageSettings& image) {
        try {
            SceneUpdate update = update_scene(time);
            if (update.scene) check_objects(*update.scene);
            put_sample(std::move(update), image);
        } catch (const Error& error) {
            const std::string where = error.where().empty() ? std::string() : error.where() + ", ";
            throw Error(error.kind(),
                        {error.message(), fmt::format("{}at frame {:.4g}", where, time), error.hint()},
                        error.further());
        }
    }

    void put_sample(SceneUpdate update, const ImageSettings& image) {
        if (move(std::move(update), image)) return;
        if (engine) keep_counts(*engine, counts);
        engine.reset(); // so that a device does not hold two
        RenderSettings changed = settings;
        changed.image = image;
        engine = make_engine(editor->scene(), changed);
    }

    bool has_motion_layer() const {
        return std::ranges::find(settings.image.layers, kMotionLayer) != settings.image.layers.end();
    }
    void find_motions(double frame, const UpdateScene& update, const Camera& camera);

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
    resume_film(checkpoints, identity, *film);
    join_parts(checkpoints.parts, settings, scene_hash, mattes, *film);
    RenderControl control(observer);
    const Timer timer;
    control.save.interval_s = checkpoints.interval_s;
    if (checkpoints.save)
        control.save.call = [&] {
            if (film->most_samples() > 0)
                checkpoints.save([&](std::ostream& stream) { film->write(stream, identity); });
        };
    show_pictures(*film, space, control);
    const MovingStage stage{
        [&](int sample, const ImageSettings& image) {
            move_sample(find_sample_time(camera, frame, sample), update, image);
        },
        [&](Film& target, const RenderControl& part) { return engine->render(target, part); }};
    if (has_motion_layer()) find_motions(frame, update, camera);
    control.spent_s = prepare_s + timer.seconds();
    try {
        const bool is_complete = render_samples(*film, settings.image, control, stage);
        if (control.save.call) control.save.call();
        return is_complete;
    } catch (...) {
        if (control.save.call) control.save.call(); // samples are added whole
        throw;
    }
}

/// Ends at the time when the shutter closes.
void Session::Implementation::find_motions(double frame, const UpdateScene& update, const Camera& camera) {
    const MotionVectors vectors(*engine, *editor->scene(), film->window());
    const auto find_places = [&](float time) {
        move_sample(frame + double(time), update, settings.image);
        return vectors.find_places(*editor->scene());
    };
    const std::vector<Vec2f> from = find_places(camera.shutter_open);
    std::vector<Vec2f> motions = find_places(camera.shutter_close);
    for (size_t k = 0; k < motions.size(); ++k) {
        const Vec2f motion{motions[k].x - from[k].x, motions[k].y - from[k].y};
        motions[k] = std::isfinite(motion.x) && std::isfinite(motion.y) ? motion : Vec2f{};
    }
    film->set_motions(std::move(motions));
}

double find_sample_time(const Camera& camera, double frame, int sample) {
    const uint32_t bits = 0x80000000u + uint32_t(sample) * 0x9e3779b9u; // of the golden ratio's fraction
    const double share = double(bits) * 0x1p-32;
    const double open = camera.shutter_open, close = camera.shutter_close;
    return frame + open + (close - open) * share;
}

Session::Session(Scene scene, const RenderSettings& settings, SessionUse use, RenderObserver* observer)
    : implementation_(std::make_unique<Implementation>(std::move(scene), settings, use, observer)) {}

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
        note_ends(settings.image, *film, result);
        result.image = film->resolve(space);
        add_metadata(settings, scene_hash, result.is_complete, *film, result.image);
    });
    statistics.total_s = statistics.prepare_s + total.seconds();
    statistics.peak_resident_bytes = peak_resident_bytes();
    return result;
}

RenderResult Session::render(RenderObserver* observer) {
    implementation_->prepare(observer, [&] { implementation_->need_engine(); });
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

void Session::change_scene(SceneUpdate update, const ImageSettings& image, RenderObserver* observer) {
    implementation_->prepare(observer, [&] { implementation_->change_scene(std::move(update), image); });
}

EditReport Session::edit(const MapEdit& edit) {
    EditReport report;
    with_threads(implementation_->settings.device.threads, [&] { report = implementation_->apply(edit); });
    return report;
}

void Session::change_view(const Camera& camera, const ImageSettings& image, uint64_t scene_hash,
                          RenderObserver* observer) {
    implementation_->prepare(observer, [&] { implementation_->change_view(camera, image, scene_hash); });
}

bool Session::is_far_away() const { return implementation_->editor->scene()->has_far_objects; }

uint64_t Session::made_surfaces() const { return implementation_->editor->made_surfaces(); }

void Session::check(const MapEdit& edit) const {
    with_threads(implementation_->settings.device.threads, [&] { implementation_->editor->check(edit); });
}

} // namespace relief
