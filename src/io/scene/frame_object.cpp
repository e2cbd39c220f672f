#include "io/scene/frame_object.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "io/scene/asset_cache.h"
#include "math/box.h"

namespace relief {

namespace {

/// Corners of one face, as positions and uvs, and its flat frame.
struct FaceFrame {
    std::array<Vec3f, 4> positions;
    std::array<Vec2f, 4> uvs;
    Vec3f t, b, n;
};

FaceFrame make_face_frame(const Mesh& mesh, size_t first, uint32_t size,
                          FrameLengths lengths = FrameLengths::absolute) {
    FaceFrame face;
    for (size_t k = 0; k < 4; ++k) {
        const size_t corner = first + std::min<size_t>(k, size - 1);
        face.positions[k] = mesh.positions[mesh.position_indices[corner]];
        if (!mesh.uv_indices.empty()) face.uvs[k] = mesh.uvs[mesh.uv_indices[corner]];
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

/// Displacement at a uv by the nearest texel: close enough to frame a picture.
Vec3f sample_displacement(const Displacement& map, const Vec2f& uv, const FaceFrame& face) {
    const MapTile* tile = &map.tiles.front();
    const float column = std::floor(uv.x), row = std::floor(uv.y);
    if (map.is_udim) {
        const auto found = std::find_if(map.tiles.begin(), map.tiles.end(), [&](const MapTile& candidate) {
            return float(candidate.udim) == 1001 + column + 10 * row;
        });
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
        return face.n * ((get_texel(texture, x, y, 0) - map.midlevel.x) * map.scale.x);
    Vec3f local;
    for (int c = 0; c < 3; ++c) {
        const float value = get_texel(texture, x, y, uint32_t(c)) - get_component(map.midlevel, c);
        set_component(local, map.axes.axis[size_t(c)],
                      value * get_component(map.scale, c) * float(map.axes.sign[size_t(c)]));
    }
    return map.space == DisplacementSpace::tangent ? face.t * local.x + face.b * local.y + face.n * local.z
                                                   : local;
}

Vec3f make_direction(float azimuth_degrees, float elevation_degrees) {
    constexpr float kRadians = std::numbers::pi_v<float> / 180;
    const float azimuth = azimuth_degrees * kRadians, elevation = elevation_degrees * kRadians;
    return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
            std::cos(azimuth) * std::cos(elevation)};
}

/// From the middle of the object to the camera.
Vec3f choose_view(const Mesh& mesh) {
    Box box;
    Vec3f normal;
    size_t first = 0;
    for (const uint32_t size : mesh.face_sizes) {
        const FaceFrame face = make_face_frame(mesh, first, size);
        for (size_t k = 0; k < size; ++k) box.extend(mesh.positions[mesh.position_indices[first + k]]);
        normal += cross(face.positions[2] - face.positions[0], face.positions[3] - face.positions[1]);
        first += size;
    }
    const Vec3f size = box.extent();
    const float largest = std::max({size.x, size.y, size.z});
    constexpr float kFlat = 0.05f;
    if (size.y < kFlat * largest) return make_direction(25, normal.y < 0 ? -40.0f : 40.0f);
    if (size.x < kFlat * largest) return make_direction(normal.x < 0 ? -65.0f : 115.0f, 18);
    if (size.z < kFlat * largest) return make_direction(normal.z < 0 ? 205.0f : 25.0f, 18);
    return make_direction(30, 22);
}

/// The camera's axes, and how far points reach along them. A point at x, y, z along right, up and view is in
/// the picture of a camera at distance d on the axis when |x| and |y| are at most tangent (d - z): so what
/// matters of a set of points is the largest value of `tangent z` plus x, -x, y and -y.
struct Reach {
    Vec3f right, up, view;
    float tangent = 0;
    std::array<float, 4> sides;

    void clear() { sides.fill(-std::numeric_limits<float>::infinity()); }
    void extend(const Vec3f& p) {
        const float x = dot(p, right), y = dot(p, up), z = tangent * dot(p, view);
        sides[0] = std::max(sides[0], z + x), sides[1] = std::max(sides[1], z - x);
        sides[2] = std::max(sides[2], z + y), sides[3] = std::max(sides[3], z - y);
    }
};

void extend_by_corners(Reach& reach, const Mesh& mesh) {
    for (const uint32_t index : mesh.position_indices) reach.extend(mesh.positions[index]);
}

/// Samples spread evenly over the faces.
void extend_by_displacement(Reach& reach, const Mesh& mesh, const Displacement& map) {
    const int steps = std::clamp(int(std::sqrt(262144.0 / double(mesh.face_sizes.size()))), 1, 512);
    size_t first = 0;
    for (const uint32_t size : mesh.face_sizes) {
        const FaceFrame face = make_face_frame(mesh, first, size, map.lengths);
        for (int j = 0; j < steps; ++j) {
            for (int i = 0; i < steps; ++i) {
                // Never on the border, where the uv may belong to the next tile.
                const float u = (float(i) + 0.5f) / float(steps), v = (float(j) + 0.5f) / float(steps);
                const auto mix = [&](const auto& c) {
                    return (c[0] * (1 - u) + c[1] * u) * (1 - v) + (c[3] * (1 - u) + c[2] * u) * v;
                };
                reach.extend(mix(face.positions) + sample_displacement(map, mix(face.uvs), face));
            }
        }
        first += size;
    }
}

/// Rounds what the displacement adds to the reach of the bare mesh to fifteenths of the mesh's size, which
/// the margin has room for: so coding errors rarely move the camera.
void coarsen(Reach& reach, const std::array<float, 4>& bare) {
    const float step = std::max(bare[0] + bare[1], bare[2] + bare[3]) / 15;
    if (!(step > 0)) return;
    for (size_t k = 0; k < 4; ++k) {
        const float steps = std::round((reach.sides[k] - bare[k]) / step);
        reach.sides[k] = bare[k] + std::max(steps, 0.0f) * step;
    }
}

} // namespace

Camera frame_object(const Mesh& mesh, const Displacement* map) {
    constexpr float kFill = 0.85f;
    Camera camera;
    Reach reach;
    reach.clear();
    reach.tangent = kFill * std::tan(camera.fov_degrees * std::numbers::pi_v<float> / 360);
    reach.view = choose_view(mesh);
    reach.right = normalize(cross(camera.up, reach.view));
    reach.up = cross(reach.view, reach.right);
    extend_by_corners(reach, mesh);
    if (map) {
        const std::array<float, 4> bare = reach.sides;
        extend_by_displacement(reach, mesh, *map);
        coarsen(reach, bare);
    }
    const auto& [right, left, top, bottom] = reach.sides;
    const float distance = std::max(right + left, top + bottom) / (2 * reach.tangent);
    Box box;
    for (const uint32_t index : mesh.position_indices) box.extend(mesh.positions[index]);
    const float middle = dot(box.center(), reach.view);
    camera.focus_distance = distance > middle ? distance - middle : 1;
    camera.to = reach.right * ((right - left) / 2) + reach.up * ((top - bottom) / 2) + reach.view * middle;
    camera.from = camera.to + reach.view * camera.focus_distance;
    return camera;
}

} // namespace relief
