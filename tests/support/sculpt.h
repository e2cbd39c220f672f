// A sculpt by a formula: a mushroom that leans and overhangs all around, on a plane two units wide.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>

#include "math/vec.h"
#include "relief/scene.h"

namespace relief::test {

inline constexpr float kSculptReach = 0.6f; ///< no displacement is longer along any axis

/// Displacement along t, b, n at u, v in [0, 1].
inline Vec3f displace_sculpt(float u, float v) {
    constexpr float kRadius = 0.7f, kSpread = 1.8f, kLean = 0.1f, kRise = 0.5f;
    const float x = 2 * u - 1, y = 2 * v - 1, q = (x * x + y * y) / (kRadius * kRadius);
    const float h = q < 1 ? (1 - q) * (1 - q) : 0.0f;
    return {kSpread * h * x + kLean * h, 0.8f * kSpread * h * y - 0.4f * kLean * h, kRise * h};
}

/// At the middle of the texel in column x and row y of a map of `size` x `size` texels.
inline Vec3f displace_sculpt_texel(uint32_t size, uint32_t x, uint32_t y) {
    return displace_sculpt((float(x) + 0.5f) / float(size), 1 - (float(y) + 0.5f) / float(size));
}

/// What channel c of a map with these axes holds for a displacement d.
inline float encode_channel(const Vec3f& d, const AxisMap& axes, size_t c) {
    return get_component(d, axes.axis[c]) * float(axes.sign[c]);
}

/// The sculpt as 32-bit floats, its channels along `axes`.
inline std::shared_ptr<Texture> make_sculpt_texture(uint32_t size, const AxisMap& axes = {}) {
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = size, texture->channel_count = 3;
    texture->file = "sculpt.exr";
    for (uint32_t y = 0; y < size; ++y)
        for (uint32_t x = 0; x < size; ++x) {
            const Vec3f d = displace_sculpt_texel(size, x, y);
            for (size_t c = 0; c < 3; ++c) texture->floats.push_back(encode_channel(d, axes, c));
            texture->floats.push_back(1);
        }
    return texture;
}

/// One quad, [-1, 1]^2 in z = 0, that a map is laid on as it is.
inline Mesh make_sculpt_plane() {
    Mesh mesh;
    mesh.name = "plane", mesh.source = "plane.obj";
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.face_sizes = {4};
    mesh.position_indices = mesh.uv_indices = {0, 1, 2, 3};
    return mesh;
}

} // namespace relief::test
