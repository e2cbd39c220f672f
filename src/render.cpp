// The whole path: scene -> surfaces and levels -> trees -> rays -> film -> image.
#include "relief/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/machine.h"
#include "base/parallel.h"
#include "base/timer.h"
#include "engine/cpu/kernels.h"
#include "engine/engine.h"
#include "validate_settings.h"

namespace relief {

namespace {

void count_scene(const PreparedScene& scene, Statistics& statistics) {
    statistics.meshes = scene.mesh_count;
    statistics.instances = scene.instances.size();
    std::vector<const Texture*> seen;
    for (const Surface& surface : scene.surfaces) {
        for (const Quad& quad : surface.quads) {
            if (surface.has_displacement)
                ++statistics.patches;
            else
                statistics.triangles += quad.is_triangle() ? 1 : 2;
        }
        for (const DisplacementMap::Tile& tile : surface.map.tiles) {
            if (std::find(seen.begin(), seen.end(), tile.texture.get()) != seen.end()) continue;
            seen.push_back(tile.texture.get());
            statistics.displacement_texels += uint64_t(tile.texture->width) * tile.texture->height;
            statistics.displacement_bytes += tile.texture->byte_count() + tile.pyramid->byte_count();
        }
    }
}

void add_metadata(const RenderSettings& settings, uint64_t scene_hash, int samples_end, Image& image) {
    image.metadata["Software"] = "Relief " RELIEF_VERSION;
    image.metadata["relief:version"] = RELIEF_VERSION;
    image.metadata["relief:seed"] = std::to_string(settings.seed);
    image.metadata["relief:samples"] = fmt::format("{}:{}", settings.first_sample, samples_end);
    image.metadata["relief:scene_hash"] = fmt::format("{:016x}", scene_hash);
}

} // namespace

RenderResult render(Scene scene, const RenderSettings& settings, RenderObserver* observer) {
    validate_settings(settings);
    validate_method(settings, scene.camera);
    const uint64_t scene_hash = scene.hash;
    RenderResult result;
    Statistics& statistics = result.statistics;
    const Timer total;
    with_threads(settings.threads, [&] {
        // First, so that a picture that cannot be held is refused before the scene is prepared.
        Film film(settings.width, settings.height, settings.crop, settings.layers);
        std::shared_ptr<const PreparedScene> prepared = prepare_scene(std::move(scene), settings);
        std::unique_ptr<Engine> engine = make_engine(prepared, settings);
        statistics.prepare_s = total.seconds();

        const Timer timer;
        result.is_complete = engine->render(film, observer);
        statistics.render_s = timer.seconds();

        engine->add_statistics(statistics);
        statistics.threads = thread_count();
        statistics.first_image_s += statistics.prepare_s;
        statistics.ray_buffers_bytes += film.byte_count();
        statistics.warnings = prepared->warnings;
        count_scene(*prepared, statistics);
        // The picture may lie where they lay.
        engine.reset(), prepared.reset();
        result.image = film.resolve();
    });
    add_metadata(settings, scene_hash, settings.first_sample + settings.spp, result.image);
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
