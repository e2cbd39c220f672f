// Tiles of rays, as pictures are traced in, and a check that hits are bit-identical to single-ray traversal.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "cpu/tracer.h"
#include "lab/scenes/peer_scenes.h"
#include "math/vec.h"

namespace relief::test {

using Rays = std::vector<cpu::TraceRay>;
using Hits = std::vector<cpu::TraceHit>;

constexpr size_t kBundle = 256; ///< more rays than this never travel together

/// Tiles of 16 x 16 rays through a picture of `tiles`^2 tiles, 4 x 4 rays after 4 x 4, `spread` wide at
/// distance 1.
inline Rays make_tiles(const Vec3f& from, const Vec3f& to, float spread, int tiles) {
    const Vec3f forward = normalize(to - from);
    const Vec3f right =
        normalize(cross(forward, std::fabs(forward.y) > 0.9f ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0}));
    const Vec3f up = cross(right, forward);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> jitter(0, 1);
    Rays rays;
    const int size = 16 * tiles;
    for (int k = 0; k < size * size; ++k) {
        const int tile = k / 256, packet = k % 256 / 16, lane = k % 16;
        const int x = tile % tiles * 16 + packet % 4 * 4 + lane % 4,
                  y = tile / tiles * 16 + packet / 4 * 4 + lane / 4;
        const float sx = (2 * (float(x) + jitter(random)) / float(size) - 1) * spread;
        const float sy = (1 - 2 * (float(y) + jitter(random)) / float(size)) * spread;
        cpu::TraceRay ray;
        ray.origin = from;
        ray.direction = (forward + right * sx + up * sy) * (0.5f + jitter(random));
        rays.push_back(ray);
    }
    return rays;
}

/// The rays in spans of `size`: 256 travel as bundles, 16 as packets, 1 alone.
inline Hits trace(const cpu::Tracer& tracer, const Rays& rays, size_t size) {
    Hits hits(rays.size());
    for (size_t begin = 0; begin < rays.size(); begin += size) {
        const size_t count = std::min(size, rays.size() - begin);
        tracer.closest_hits(std::span(rays).subspan(begin, count), std::span(hits).subspan(begin, count));
    }
    return hits;
}

/// Bit for bit: -0 is not 0.
inline bool is_same(const cpu::TraceHit& a, const cpu::TraceHit& b) {
    const auto bits = [](float value) { return std::bit_cast<uint32_t>(value); };
    return bits(a.t) == bits(b.t) && a.instance == b.instance && a.patch == b.patch &&
           bits(a.u) == bits(b.u) && bits(a.v) == bits(b.v) && a.i == b.i && a.j == b.j &&
           a.is_upper == b.is_upper && a.levels == b.levels && a.lod_bias == b.lod_bias;
}

inline size_t count_different(const Hits& a, const Hits& b) {
    size_t count = 0;
    for (size_t k = 0; k < a.size(); ++k) count += !is_same(a[k], b[k]);
    return count;
}

/// Returns how many rays met something.
inline size_t expect_same(const cpu::Tracer& tracer, const Rays& rays, const std::string& what) {
    const Hits bundled = trace(tracer, rays, kBundle), alone = trace(tracer, rays, 1);
    EXPECT_EQ(count_different(bundled, alone), 0u) << what << ", against single rays";
    EXPECT_EQ(count_different(bundled, trace(tracer, rays, 16)), 0u) << what << ", against packets";
    return size_t(std::count_if(alone.begin(), alone.end(), [](const auto& hit) { return hit.is_hit(); }));
}

inline cpu::Tracer make_tracer(const Scene& scene, int level, Isa isa,
                               SurfaceMode surface = SurfaceMode::direct) {
    RenderSettings settings;
    settings.image.width = 320, settings.image.height = 180;
    settings.surface.level = level, settings.device.isa = isa, settings.surface.mode = surface;
    return cpu::Tracer(prepare_scene(scene, settings), settings);
}

inline const Scene& rock() {
    static const Scene scene = make_peer_scene("rock", 1, PeerWorld::constant);
    return scene;
}

/// Rock after rock: turned, sheared, mirrored, and one flat as a coin; polygons below and behind them.
inline Scene make_many_spaces() {
    Scene scene = rock();
    const auto place = [&](const Vec3f& x, const Vec3f& y, const Vec3f& z, const Vec3f& at) {
        Object object = scene.objects[0];
        object.world_from_object = {{Vec3f{x.x, y.x, z.x}, Vec3f{x.y, y.y, z.y}, Vec3f{x.z, y.z, z.z}}, at};
        scene.objects.push_back(object);
    };
    place({0.6f, 0.3f, 0}, {-0.3f, 0.6f, 0}, {0, 0, 0.7f}, {2, 0, 0});
    place({0.7f, 0, 0.4f}, {0.5f, 0.7f, 0}, {0, 0, 0.6f}, {-2, 0.2f, 0.3f});
    place({-0.6f, 0, 0}, {0, 0.6f, 0}, {0, 0, 0.6f}, {0, 1.8f, 0});
    place({0.9f, 0, 0}, {0, 0.01f, 0}, {0, 0, 0.9f}, {0, -1.6f, 0});
    Mesh ground;
    ground.name = "ground";
    ground.positions = {{-40, -2, 40}, {40, -2, 40}, {40, -2, -40}, {-40, -2, -40}, {0, 3, -6}};
    ground.face_sizes = {4, 3};
    ground.position_indices = {0, 1, 2, 3, 3, 2, 4};
    Object plain;
    plain.name = ground.name, plain.mesh = uint32_t(scene.meshes.size());
    scene.meshes.push_back(ground);
    scene.objects.push_back(plain);
    return scene;
}

} // namespace relief::test
