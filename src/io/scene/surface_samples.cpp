#include "io/scene/surface_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/udim.h"
#include "io/scene/asset_cache.h"
#include "math/affine.h"
#include "scene/coordinate_limit.h"
#include "scene/displacement_conventions.h"

namespace relief {

namespace {

/// Corners of one face, as positions and uvs, and its flat frame.
struct FaceFrame {
    std::array<Vec3f, 4> positions;
    std::array<Vec2f, 4> uvs;
    Vec3f t, b, n;
    bool has_uvs = false;
};

FaceFrame make_face_frame(const Mesh& mesh, size_t first, uint32_t size, FrameLengths lengths) {
    FaceFrame face;
    for (size_t k = 0; k < 4; ++k) {
        const size_t corner = first + std::min<size_t>(k, size - 1);
        face.positions[k] = mesh.positions[mesh.position_indices[corner]];
        face.has_uvs = !mesh.uv_indices.empty() && mesh.uv_indices[corner] != kNoIndex;
        if (face.has_uvs) face.uvs[k] = mesh.uvs[mesh.uv_indices[corner]];
    }
    const Vec3f a = face.positions[1] - face.positions[0], c = face.positions[2] - face.positions[0];
    const Vec2f ua = face.uvs[1] - face.uvs[0], uc = face.uvs[2] - face.uvs[0];
    const float determinant = ua.x * uc.y - ua.y * uc.x;
    const float sign = determinant < 0 ? -1.0f : 1.0f;
    face.n = normalize(cross(a, c));
    const Vec3f along_u = (a * uc.y - c * ua.y) * sign;
    face.t = normalize(along_u - face.n * dot(face.n, along_u));
    face.b = cross(face.n, face.t) * sign;
    if (lengths == FrameLengths::relative && determinant != 0) {
        face.t = (a * uc.y - c * ua.y) / determinant;
        face.b = (c * ua.x - a * uc.x) / determinant;
    }
    return face;
}

/// The map's vector at a uv, before it goes through a frame; 0 where there is no tile.
Vec3f fetch_nearest(const Displacement& map, const Vec2f& uv) {
    const MapTile* tile = &map.tiles.front();
    const float column = std::floor(uv.x), row = std::floor(uv.y);
    if (map.is_udim) {
        const std::optional<int> udim = find_udim(column, row);
        if (!udim) return {};
        const auto found = std::ranges::find(map.tiles, *udim, &MapTile::udim);
        if (found == map.tiles.end()) return {};
        tile = &*found;
    }
    const Texture& texture = *tile->texture;
    const float v = uv.y - row;
    const auto to_texel = [](float f, uint32_t size) {
        return uint32_t(std::clamp(f * float(size), 0.0f, float(size - 1)));
    };
    const uint32_t x = to_texel(uv.x - column, texture.width);
    const uint32_t y = to_texel(map.flip_v ? v : 1 - v, texture.height);
    if (map.type == DisplacementType::height)
        return {0, 0, (get_texel(texture, x, y, 0) - map.midlevel.x) * map.scale.x};
    Vec3f local;
    for (int c = 0; c < 3; ++c) {
        const float value = get_texel(texture, x, y, uint32_t(c)) - get_component(map.midlevel, c);
        set_component(local, map.axes.axis[size_t(c)],
                      value * get_component(map.scale, c) * float(map.axes.sign[size_t(c)]));
    }
    return local;
}

/// A camera cannot be placed by values that a render refuses.
void check_reach(const Displacement& map, const Vec3f& d) {
    const double reach = std::max({std::fabs(double(d.x)), std::fabs(double(d.y)), std::fabs(double(d.z))});
    if (reach > kLargestCoordinate) refuse_reach(map.name, map.tiles.front().texture->file, reach);
}

Vec3f displace(const Displacement& map, const Vec2f& uv, const FaceFrame& face,
               const Affine& object_from_world) {
    const Vec3f local = fetch_nearest(map, uv);
    check_reach(map, local);
    if (map.type == DisplacementType::height || map.space == DisplacementSpace::tangent)
        return face.t * local.x + face.b * local.y + face.n * local.z;
    return map.space == DisplacementSpace::world ? transform_vector(object_from_world, local) : local;
}

} // namespace

DisplacedSamples::DisplacedSamples(const Mesh& mesh, const Displacement& map, const Affine& object_from_world,
                                   double count)
    : mesh_(mesh),
      map_(map),
      object_from_world_(object_from_world),
      steps_(std::clamp(int(std::sqrt(count / double(mesh.face_sizes.size()))), 1, 512)) {
    size_t first = 0;
    starts_.reserve(mesh.face_sizes.size());
    for (const uint32_t size : mesh.face_sizes) starts_.push_back(first), first += size;
}

void DisplacedSamples::append_row(size_t row, std::vector<Vec3f>& points) const {
    const size_t number = row / size_t(steps_);
    const FaceFrame face = make_face_frame(mesh_, starts_[number], mesh_.face_sizes[number], map_.lengths);
    // Never on the border, where the uv may belong to the next tile.
    const float v = (float(row % size_t(steps_)) + 0.5f) / float(steps_);
    for (int i = 0; i < steps_; ++i) {
        const float u = (float(i) + 0.5f) / float(steps_);
        const auto mix = [&](const auto& c) {
            return (c[0] * (1 - u) + c[1] * u) * (1 - v) + (c[3] * (1 - u) + c[2] * u) * v;
        };
        Vec3f offset{};
        if (face.has_uvs) offset = displace(map_, mix(face.uvs), face, object_from_world_);
        points.push_back(mix(face.positions) + offset);
    }
}

Vec3f sum_area_vectors(const Mesh& mesh) {
    Vec3f sum;
    size_t first = 0;
    for (const uint32_t size : mesh.face_sizes) {
        const auto corner = [&](size_t k) {
            return mesh.positions[mesh.position_indices[first + std::min<size_t>(k, size - 1)]];
        };
        sum += cross(corner(2) - corner(0), corner(3) - corner(1));
        first += size;
    }
    return sum;
}

} // namespace relief
