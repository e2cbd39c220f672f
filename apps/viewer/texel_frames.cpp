#include "viewer/texel_frames.h"

#include <algorithm>

#include "common/texel_values.h"
#include "common/vectors.h"
#include "relief/convert.h"

namespace relief::viewer {

using namespace vectors;

namespace {

/// Texels a side: frames vary with the faces of the mesh, not with the texels of its map.
constexpr uint32_t kFrameSide = 256;

Displacement make_constant_map(const Displacement& like, const Vec3f& value) {
    Texture texture;
    texture.width = texture.height = kFrameSide;
    texture.channel_count = 3;
    texture.floats.resize(size_t(4) * kFrameSide * kFrameSide);
    for (size_t k = 0; k < texture.floats.size(); k += 4) {
        texture.floats[k] = value.x, texture.floats[k + 1] = value.y, texture.floats[k + 2] = value.z;
        texture.floats[k + 3] = 1;
    }
    const auto shared = std::make_shared<const Texture>(std::move(texture));
    Displacement map;
    map.name = like.name;
    map.space = DisplacementSpace::object;
    map.is_udim = like.is_udim;
    map.flip_v = like.flip_v;
    for (const MapTile& tile : like.tiles) map.tiles.push_back({tile.udim, shared});
    return map;
}

} // namespace

TexelFrames::TexelFrames(const Displacement& map, const Mesh& mesh) {
    Displacement to;
    to.frame = map.frame;
    to.lengths = map.lengths;
    to.flip_v = map.flip_v;
    for (const Vec3f& axis : {Vec3f{1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{0, 0, 1}})
        axes_.push_back(convert_map(make_constant_map(map, axis), to, &mesh));
}

Vec3f TexelFrames::express(const Vec3f& direction, int udim, float column, float row) const {
    const auto place = [](float share) {
        return uint32_t(std::clamp(share * float(kFrameSide), 0.0f, float(kFrameSide - 1)));
    };
    const float along[] = {direction.x, direction.y, direction.z};
    Vec3f sum{};
    for (size_t c = 0; c < 3; ++c)
        for (const MapTile& tile : axes_[c].tiles)
            if (tile.udim == udim)
                sum = sum + read_texel(*tile.texture, place(column), place(row)) * along[c];
    return sum;
}

} // namespace relief::viewer
