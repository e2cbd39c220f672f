#include "io/scene/scene_content.h"

#include <array>
#include <set>

namespace relief {

void add_scene_content(ContentHash& hash, const Scene& scene) {
    for (const Mesh& mesh : scene.meshes) {
        hash.add(mesh.positions), hash.add(mesh.uvs), hash.add(mesh.normals), hash.add(mesh.face_sizes);
        hash.add(mesh.position_indices), hash.add(mesh.uv_indices), hash.add(mesh.normal_indices);
        hash.add(mesh.tangents), hash.add(mesh.creases);
        const Subdivision& subdivision = mesh.subdivision;
        if (subdivision.scheme == SubdivisionScheme::none) continue;
        hash.add(std::array{uint32_t(subdivision.scheme), uint32_t(subdivision.level),
                            uint32_t(subdivision.uv), uint32_t(subdivision.boundary),
                            uint32_t(subdivision.creases)});
    }
    std::set<const Texture*> seen;
    const auto add_texture = [&](const std::shared_ptr<const Texture>& texture) {
        if (!texture || !seen.insert(texture.get()).second) return;
        hash.add(std::array{texture->width, texture->height, texture->channel_count});
        hash.add(texture->floats), hash.add(texture->halves);
    };
    for (const Displacement& displacement : scene.displacements)
        for (const MapTile& tile : displacement.tiles) {
            hash.add(std::array{uint32_t(tile.udim)});
            add_texture(tile.texture);
        }
    for (const Material& material : scene.materials)
        visit_textures(material, [&](const char*, const auto& texture, MapFilter) { add_texture(texture); });
    if (scene.environment) add_texture(scene.environment->texture);
    for (const Light& light : scene.lights) add_texture(light.color_texture);
}

} // namespace relief
