// The whole pipeline: scene -> surfaces and levels -> trees -> rays -> film -> image.
#include "relief/render.h"

#include <ostream>
#include <utility>

#include "api/instance_mattes.h"
#include "api/join_parts.h"
#include "api/make_engine.h"
#include "api/picture_report.h"
#include "base/machine.h"
#include "base/parallel.h"
#include "base/timer.h"
#include "cpu/traversal/kernels.h"
#include "prepare/prepared_scene.h"
#include "prepare/validate_settings.h"

namespace relief {

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
        if (checkpoints.resume) film.read(*checkpoints.resume, identity);
        join_parts(checkpoints.parts, settings, scene_hash, mattes, film);
        std::shared_ptr<const PreparedScene> prepared =
            prepare_scene(std::move(scene), settings, SceneOrigin::camera);
        std::unique_ptr<Engine> engine = make_engine(prepared, settings);
        statistics.prepare_s = total.seconds();

        if (observer) observer->on_warnings(prepared->warnings);
        const Timer timer;
        RenderControl control(observer);
        control.save.interval_s = checkpoints.interval_s;
        if (checkpoints.save)
            control.save.call = [&] {
                if (film.most_samples() > 0)
                    checkpoints.save([&](std::ostream& s) { film.write(s, identity); });
            };
        show_pictures(film, make_picture_space(*prepared), control);
        try {
            result.is_complete = engine->render(film, control);
        } catch (...) {
            if (control.save.call)
                control.save.call(); // samples are added whole: a lost device loses no others
            throw;
        }
        statistics.render_s = timer.seconds();
        if (control.save.call) control.save.call();

        SessionCounts counts;
        collect_statistics(*engine, film, *prepared, statistics, counts);
        const PictureSpace space = make_picture_space(*prepared);
        // Frees their memory before the image is allocated.
        engine.reset(), prepared.reset();
        result.whole_samples = int(film.least_samples());
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
