// The whole pipeline: scene -> surfaces and levels -> trees -> rays -> film -> image.
#include "relief/render.h"

#include <memory>
#include <optional>
#include <ostream>
#include <utility>

#include "api/instance_mattes.h"
#include "api/join_parts.h"
#include "api/make_engine.h"
#include "api/picture_report.h"
#include "api/prepare_scope.h"
#include "base/machine.h"
#include "base/parallel.h"
#include "base/stop_request.h"
#include "base/timer.h"
#include "cpu/traversal/kernels.h"
#include "prepare/prepared_scene.h"
#include "prepare/validate_settings.h"

namespace relief {

namespace {

struct Stage {
    std::shared_ptr<const PreparedScene> scene;
    std::unique_ptr<Engine> engine;
};

/// None where the observer cancels meanwhile.
std::optional<Stage> set_up(Scene&& scene, const RenderSettings& settings, RenderObserver* observer) {
    const PrepareScope scope(observer);
    try {
        Stage stage{prepare_scene(std::move(scene), settings, SceneOrigin::camera), nullptr};
        stage.engine = make_engine(stage.scene, settings);
        return stage;
    } catch (const StopRequest&) {
        return std::nullopt;
    }
}

/// `film` and `identity` are read when it saves.
RenderControl make_control(RenderObserver* observer, const Checkpoints& checkpoints, const Film& film,
                           const std::string& identity) {
    RenderControl control(observer);
    control.save.interval_s = checkpoints.interval_s;
    if (checkpoints.save)
        control.save.call = [&] {
            if (film.most_samples() > 0) checkpoints.save([&](std::ostream& s) { film.write(s, identity); });
        };
    return control;
}

} // namespace

RenderResult render(Scene scene, const RenderSettings& given, RenderObserver* observer,
                    const Checkpoints& checkpoints) {
    validate_settings(given);
    const RenderSettings settings = complete_settings(given, has_shadow_catchers(scene));
    validate_method(settings, scene.camera);
    const uint64_t scene_hash = scene.hash;
    RenderResult result;
    Statistics& statistics = result.statistics;
    const Timer total;
    with_threads(settings.device.threads, [&] {
        // First, so that a picture too large for memory is rejected before the scene is prepared.
        const auto mattes = make_instance_mattes(scene, settings.image.layers);
        Film film = make_film(settings.image, mattes);
        const std::string identity = describe_samples(settings, scene_hash);
        resume_film(checkpoints, identity, film);
        join_parts(checkpoints.parts, settings, scene_hash, mattes, film);
        std::optional<Stage> stage = set_up(std::move(scene), settings, observer);
        statistics.prepare_s = total.seconds();
        if (!stage) {
            result.is_complete = false;
            result.image = film.resolve();
            add_metadata(settings, scene_hash, false, film, result.image);
            return;
        }

        if (observer) observer->on_warnings(stage->scene->warnings);
        const Timer timer;
        RenderControl control = make_control(observer, checkpoints, film, identity);
        control.spent_s = total.seconds();
        const PictureSpace space = make_picture_space(*stage->scene);
        show_pictures(film, space, control);
        try {
            result.is_complete = stage->engine->render(film, control);
        } catch (...) { // samples are added whole, so that a lost device loses no others
            if (control.save.call) control.save.call();
            throw;
        }
        statistics.render_s = timer.seconds();
        if (control.save.call) control.save.call();

        SessionCounts counts;
        collect_statistics(*stage->engine, film, *stage->scene, statistics, counts);
        stage.reset(); // frees its memory before the image is allocated
        note_ends(settings.image, film, result);
        result.image = film.resolve(space);
        add_metadata(settings, scene_hash, result.is_complete, film, result.image);
    });
    statistics.total_s = total.seconds();
    statistics.peak_resident_bytes = peak_resident_bytes();
    return result;
}

std::vector<std::string> available_isas() {
    std::vector<std::string> names;
    for (const Isa isa : {Isa::avx512, Isa::avx2, Isa::neon, Isa::sse4, Isa::scalar})
        if (const cpu::Kernels* kernels = cpu::find_kernels(isa)) names.push_back(kernels->name);
    return names;
}

} // namespace relief
