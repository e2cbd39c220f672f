#include "viewer/texel_frames.h"

#include <algorithm>

#include "common/texel_values.h"
#include "common/vectors.h"
#include "relief/convert.h"

namespace relief::viewer {

using namespace vectors;

namespace {

/// Texels per side: frames vary with the faces of the mesh, not with the texels of its map. Maps with many
/// tiles have fewer of them in each, down to the least.
constexpr uint32_t kMostSide = 256, kLeastSide = 64;
constexpr size_t kMostTexels = size_t(1) << 20; ///< all tiles together have no more, or the least side

uint32_t choose_side(size_t tiles) {
    uint32_t side = kMostSide;
    while (side > kLeastSide && tiles * side * side > kMostTexels) side /= 2;
    return side;
}

Displacement make_constant_map(const Displacement& like, const Vec3f& value) {
    const uint32_t side = choose_side(like.tiles.size());
    Texture texture;
    texture.width = texture.height = side;
    texture.channel_count = 3;
    texture.floats.resize(size_t(4) * side * side);
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
    const auto place = [](float share, uint32_t side) {
        return uint32_t(std::clamp(share * float(side), 0.0f, float(side - 1)));
    };
    const float along[] = {direction.x, direction.y, direction.z};
    Vec3f sum{};
    for (size_t c = 0; c < 3; ++c)
        for (const MapTile& tile : axes_[c].tiles)
            if (tile.udim == udim)
                sum = sum + read_texel(*tile.texture, place(column, tile.texture->width),
                                       place(row, tile.texture->height)) *
                                along[c];
    return sum;
}

} // namespace relief::viewer
