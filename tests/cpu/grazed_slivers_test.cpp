// Rays that graze long and narrow triangles hit them, although single precision cannot tell whether such a
// hit is ahead of the ray's origin or behind it.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "cpu/tracer.h"
#include "math/vec.h"
#include "support/bodies.h"
#include "support/isas.h"

namespace relief::cpu {
namespace {

constexpr float kLength = 72, kWidth = 0.06f;
constexpr float kSlope = 8e-4f; ///< of rays to the triangles
constexpr float kAhead = 0.05f; ///< how far ahead of their origin the rays meet the surface

/// A corner and two edges of a narrow rectangle that lies along no axis.
struct Sliver {
    Vec3f corner, along = normalize(Vec3f{0.6f, 0.7f, 0.4f}) * kLength, across;

    Sliver() {
        across = normalize(cross(along, Vec3f{0.3f, -0.2f, 0.9f})) * kWidth;
        corner = (along + across) * -0.5f;
    }
    Vec3f at(float u, float v) const { return corner + along * u + across * v; }
};

Scene make_scene(bool is_displaced) {
    const Sliver sliver;
    Mesh mesh;
    mesh.positions = {sliver.at(0, 0), sliver.at(1, 0), sliver.at(1, 1), sliver.at(0, 1)};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.face_sizes = {4};
    mesh.position_indices = mesh.uv_indices = {0, 1, 2, 3};
    if (is_displaced)
        return test::make_body_scene(
            std::move(mesh),
            test::make_displacement(test::make_random_map(8, 8, 0, 1), DisplacementSpace::object));
    Scene scene;
    scene.meshes = {std::move(mesh)};
    scene.objects.emplace_back();
    return scene;
}

/// Groups of sixteen nearly parallel rays towards points well within the rectangle and off its diagonal.
std::vector<TraceRay> make_rays(size_t group_count) {
    const Sliver sliver;
    const Vec3f x = normalize(sliver.along), y = normalize(sliver.across), normal = cross(x, y);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> angle(0.5f, 1.2f), place(0.2f, 0.4f), jitter(-1e-5f, 1e-5f);
    std::vector<TraceRay> rays;
    for (size_t group = 0; group < group_count; ++group) {
        const float of_group = angle(random), u = place(random), v = u + place(random);
        for (int k = 0; k < 16; ++k) {
            const float a = of_group + jitter(random);
            TraceRay ray;
            ray.direction = normalize(x * std::cos(a) + y * std::sin(a) + normal * kSlope);
            ray.origin = sliver.at(u + jitter(random), v) - ray.direction * kAhead;
            rays.push_back(ray);
        }
    }
    return rays;
}

class GrazedSlivers : public testing::TestWithParam<bool> {};

TEST_P(GrazedSlivers, are_hit_by_rays_that_start_near_them) {
    RenderSettings settings;
    settings.surface.level = 0;
    const auto scene = prepare_scene(make_scene(GetParam()), settings);
    const std::vector<TraceRay> rays = make_rays(500);
    for (const Isa isa : test::machine_isas()) {
        settings.device.isa = isa;
        const Tracer tracer(scene, settings);
        std::vector<TraceHit> together(rays.size()), alone(1);
        tracer.closest_hits(rays, together);
        size_t missed = 0;
        for (size_t k = 0; k < rays.size(); ++k) {
            missed += !together[k].is_hit();
            tracer.closest_hits(std::span(rays).subspan(k, 1), alone);
            ASSERT_EQ(together[k].t, alone[0].t) << int(isa) << ", ray " << k;
        }
        EXPECT_EQ(missed, 0u) << int(isa);
    }
}

INSTANTIATE_TEST_SUITE_P(Surfaces, GrazedSlivers, testing::Bool(),
                         [](const testing::TestParamInfo<bool>& info) {
                             return info.param ? "displaced" : "undisplaced";
                         });

} // namespace
} // namespace relief::cpu
