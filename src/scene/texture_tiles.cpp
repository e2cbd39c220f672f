#include "scene/texture_tiles.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scene/material_inputs.h"
#include "scene/tile_use.h"
#include "scene/uv_sets.h"

namespace relief {

namespace {

/// Warns of one texture after another, and looks only once at what several of them read alike.
class TextureTiles {
  public:
    explicit TextureTiles(const Scene& scene) : scene_(scene) {}

    void add(uint32_t mesh, const Material& material, const InputTexture& texture) {
        const TileUse& use = find_use(mesh, texture);
        const char* const input = get_input_kind(texture.input).name;
        const std::string& mesh_name = scene_.meshes[mesh].name;
        if (const std::set<int> missing = find_missing_tiles(use.tiles, texture.tiles); !missing.empty())
            warnings_.push_back(fmt::format(
                "the texture of {} of material '{}' has no file for tile(s) {} of mesh '{}', which takes the "
                "constant of the material there: export the missing ones, or look at their names",
                input, material.name, fmt::join(missing, ", "), mesh_name));
        if (use.outside > 0)
            warnings_.push_back(
                fmt::format("the texture of {} of material '{}' on mesh '{}': {}: textures with tiles do not "
                            "cover such uvs; move them into a tile",
                            input, material.name, mesh_name, describe_outside_faces(use)));
    }

    std::vector<std::string> take() { return std::move(warnings_); }

  private:
    /// Index of the mesh, number of the uv set, scale and offset of the uvs.
    using Key = std::pair<std::pair<uint32_t, int>, std::array<float, 4>>;

    const TileUse& find_use(uint32_t mesh_index, const InputTexture& texture) {
        const Vec2f scale = texture.uv_scale, offset = texture.uv_offset;
        const Key key{{mesh_index, texture.uv_set}, {scale.x, scale.y, offset.x, offset.y}};
        const auto [place, is_new] = uses_.try_emplace(key);
        if (is_new) place->second = find_tile_use(find_uvs(scene_.meshes[mesh_index], texture));
        return place->second;
    }

    static FaceUvs find_uvs(const Mesh& mesh, const InputTexture& texture) {
        FaceUvs uvs{mesh.face_sizes, mesh.uvs, mesh.uv_indices, texture.uv_scale, texture.uv_offset};
        if (const UvSet* const set = find_further_set(mesh, texture.uv_set))
            uvs.uvs = set->uvs, uvs.indices = set->indices;
        return uvs;
    }

    const Scene& scene_;
    std::map<Key, TileUse> uses_;
    std::vector<std::string> warnings_;
};

} // namespace

std::vector<std::string> find_texture_tile_warnings(const Scene& scene) {
    TextureTiles tiles(scene);
    std::set<std::pair<uint32_t, uint32_t>> pairs;
    for (const Object& object : scene.objects) {
        if (object.material == kNoIndex || !pairs.insert({object.mesh, object.material}).second) continue;
        const Material& material = scene.materials[object.material];
        for (const InputTexture& texture : material.textures)
            if (texture.is_udim) tiles.add(object.mesh, material, texture);
    }
    return tiles.take();
}

} // namespace relief
