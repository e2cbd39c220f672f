#include "picture_report.h"

#include <algorithm>

#include <fmt/format.h>

namespace relief {

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

void add_metadata(const RenderSettings& settings, uint64_t scene_hash, Image& image) {
    image.metadata["Software"] = "Relief " RELIEF_VERSION;
    image.metadata["relief:version"] = RELIEF_VERSION;
    image.metadata["relief:seed"] = std::to_string(settings.seed);
    image.metadata["relief:samples"] =
        fmt::format("{}:{}", settings.first_sample, settings.first_sample + settings.spp);
    image.metadata["relief:scene_hash"] = fmt::format("{:016x}", scene_hash);
}

} // namespace relief
