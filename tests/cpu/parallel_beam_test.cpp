// Rays through a lens, and others that go about the same way from places of their own, traced as a parallel
// beam: the same hits, bit for bit, as sixteen at a time and one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "math/vec.h"
#include "relief/render.h"
#include "support/isas.h"
#include "support/ray_tiles.h"

namespace relief {

namespace {

using namespace test;

/// The rays of make_tiles, each from a place of its own on a lens about `from` and through the same point at
/// distance `focus`.
Rays make_lens_tiles(const Vec3f& from, const Vec3f& to, float spread, int tiles, float radius, float focus) {
    Rays rays = make_tiles(from, to, spread, tiles);
    const Vec3f forward = normalize(to - from);
    const Vec3f right =
        normalize(cross(forward, std::fabs(forward.y) > 0.9f ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0}));
    const Vec3f up = cross(right, forward);
    std::mt19937 random(8);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (cpu::TraceRay& ray : rays) {
        const Vec3f target = ray.origin + normalize(ray.direction) * focus;
        ray.origin = ray.origin + (right * unit(random) + up * unit(random)) * radius;
        ray.direction = (target - ray.origin) * (length(ray.direction) / focus);
    }
    return rays;
}

/// Parallel rays through `size`^2 positions of tiles about the origin.
Rays make_parallel_tiles(const Vec3f& direction, float width, int tiles) {
    const Vec3f forward = normalize(direction);
    Rays rays = make_tiles(forward * -5.0f, {}, 1, tiles);
    for (cpu::TraceRay& ray : rays) {
        const Vec3f aside = ray.direction * (1 / dot(ray.direction, forward)) - forward;
        ray.origin = ray.origin + aside * (0.5f * width);
        ray.direction = direction;
    }
    return rays;
}

/// Nodes above patches that are visited for rays in spans of `size`.
uint64_t count_upper_nodes(const cpu::Tracer& tracer, const Rays& rays, size_t size) {
    Statistics before, after;
    tracer.add_statistics(before);
    trace(tracer, rays, size);
    tracer.add_statistics(after);
    return after.upper_nodes - before.upper_nodes;
}

/// As expect_same, and rays did travel as beams.
size_t expect_same_as_beam(const cpu::Tracer& tracer, const Rays& rays, const std::string& what) {
    EXPECT_LT(count_upper_nodes(tracer, rays, kBundle), count_upper_nodes(tracer, rays, 16)) << what;
    return expect_same(tracer, rays, what);
}

TEST(ParallelBeam, finds_what_single_rays_find_at_every_level) {
    for (const Isa isa : machine_isas())
        for (const int level : {0, 1, 2, 3, 4, 5, 6, 7, 8, kAutoLevel}) {
            const cpu::Tracer tracer = make_tracer(rock(), level, isa);
            const Rays rays = make_lens_tiles({1.2f, 1.0f, 3.6f}, {}, 0.2f, 4, 0.04f, 3.9f);
            const std::string what = "isa " + std::to_string(int(isa)) + ", level " + std::to_string(level);
            EXPECT_GT(expect_same_as_beam(tracer, rays, what), 1000u);
        }
}

TEST(ParallelBeam, finds_it_whatever_is_in_focus) {
    for (const Isa isa : machine_isas()) {
        const cpu::Tracer tracer = make_tracer(rock(), 4, isa);
        for (const float radius : {1e-5f, 1e-3f, 0.02f, 0.2f})
            for (const float focus : {0.5f, 2.7f, 4.0f, 30.0f, 1e6f}) {
                const Rays rays = make_lens_tiles({1.2f, 1.0f, 3.6f}, {}, 0.15f, 3, radius, focus);
                const std::string what = std::to_string(radius) + " at " + std::to_string(focus);
                radius < 0.02f * focus ? expect_same_as_beam(tracer, rays, what)
                                       : expect_same(tracer, rays, what);
            }
    }
}

TEST(ParallelBeam, visits_fewer_nodes_than_packets) {
    const cpu::Tracer tracer = make_tracer(rock(), 4, Isa::best);
    for (const Rays& rays : {make_lens_tiles({1.2f, 1.0f, 3.6f}, {}, 0.2f, 4, 0.02f, 3.9f),
                             make_parallel_tiles({0.3f, -0.2f, -1}, 2, 4)}) {
        const uint64_t together = count_upper_nodes(tracer, rays, kBundle);
        EXPECT_GT(together, 0u);
        EXPECT_LT(2 * together, count_upper_nodes(tracer, rays, 16));
    }
}

TEST(ParallelBeam, finds_it_from_inside_and_close_by_and_far_away) {
    for (const Isa isa : machine_isas()) {
        const cpu::Tracer tracer = make_tracer(rock(), 4, isa);
        const auto count = [&](const Vec3f& from, const Vec3f& to, float spread, float radius, float focus) {
            return expect_same_as_beam(tracer, make_lens_tiles(from, to, spread, 4, radius, focus),
                                       "isa " + std::to_string(int(isa)) + ", from " +
                                           std::to_string(from.x));
        };
        EXPECT_GT(count({0, 0, 0}, {0.3f, 0.2f, 1}, 0.2f, 0.01f, 1.0f), 4000u);
        EXPECT_GT(count({0, 0, 1.3f}, {0.5f, 0.3f, 0}, 0.2f, 0.004f, 0.4f), 500u);
        EXPECT_GT(count({700, 30, 20}, {}, 0.002f, 0.3f, 700.0f), 500u);
        EXPECT_GT(count({0, 4, 0}, {}, 0.2f, 0.01f, 3.0f), 100u);
    }
}

TEST(ParallelBeam, finds_it_along_parallel_rays_in_every_space) {
    const Scene scene = make_many_spaces();
    for (const Isa isa : machine_isas()) {
        const cpu::Tracer tracer = make_tracer(scene, 3, isa);
        const std::string name = "isa " + std::to_string(int(isa));
        EXPECT_GT(expect_same_as_beam(tracer, make_parallel_tiles({0.3f, -0.2f, -1}, 5, 6), name), 3000u);
        EXPECT_GT(expect_same_as_beam(tracer, make_parallel_tiles({0, -2, 0}, 5, 4), name + ", down"), 1000u);
        EXPECT_GT(expect_same_as_beam(tracer, make_lens_tiles({1, 1.5f, 5}, {}, 0.3f, 6, 0.05f, 5),
                                      name + ", lens"),
                  3000u);
    }
}

TEST(ParallelBeam, may_be_any_number_of_rays_with_limits_of_their_own) {
    const cpu::Tracer tracer = make_tracer(rock(), 4, Isa::best);
    Rays rays = make_lens_tiles({1.2f, 1.0f, 3.6f}, {}, 0.1f, 2, 0.03f, 3.5f);
    std::mt19937 random(9);
    std::uniform_real_distribution<float> place(-2, 12);
    for (cpu::TraceRay& ray : rays) {
        const float a = place(random), b = place(random);
        ray.t_min = std::fmin(a, b) * 0.5f, ray.t_max = std::fmax(a, b);
    }
    Rays forward = rays;
    for (cpu::TraceRay& ray : forward) {
        ray.t_min = std::fmax(ray.t_min, 0.0f);
        ray.t_max = std::fmax(ray.t_max, ray.t_min);
    }
    forward[17].t_min = -0.0f;
    for (const size_t count : {63, 64, 65, 100, 255, 256, 300, 1000}) {
        const std::string what = std::to_string(count) + " rays";
        const auto first = [&](const Rays& of) { return Rays(of.begin(), of.begin() + long(count)); };
        EXPECT_GT(expect_same(tracer, first(rays), what + ", some from before their origins"), count / 8);
        EXPECT_GT(count < 64 ? expect_same(tracer, first(forward), what)
                             : expect_same_as_beam(tracer, first(forward), what),
                  count / 8);
    }
}

TEST(ParallelBeam, is_of_one_lod_bias) {
    const cpu::Tracer tracer = make_tracer(rock(), 5, Isa::best);
    Rays rays = make_lens_tiles({1.2f, 1.0f, 3.6f}, {}, 0.1f, 2, 0.03f, 3.5f);
    for (cpu::TraceRay& ray : rays) ray.lod_bias = 2;
    expect_same_as_beam(tracer, rays, "bias 2");
    for (size_t k = 100; k < rays.size(); k += 300) rays[k].lod_bias = 1;
    expect_same_as_beam(tracer, rays, "two of them");
}

/// The rock far from the origin of the world, where places have few digits, and rays that start close to it.
TEST(ParallelBeam, finds_it_where_coordinates_are_large) {
    for (const float far : {1e3f, 1e5f, 3e6f}) {
        Scene scene = rock();
        const float size = std::fmax(1.0f, 1e-4f * far);
        const Vec3f at{far, -0.7f * far, 0.4f * far};
        for (Vec3f& p : scene.meshes[0].positions) p = p * size + at;
        const cpu::Tracer tracer = make_tracer(scene, 3, Isa::best);
        for (const float distance : {0.9f * size, size, 1.1f * size, 1.5f * size, 5 * size}) {
            const Vec3f from = at + normalize(Vec3f{1.2f, 1.0f, 3.6f}) * distance;
            const std::string what = std::to_string(far) + " from " + std::to_string(distance);
            for (const float radius : {0.01f * size, 0.03f * size})
                expect_same(tracer, make_lens_tiles(from, at, 0.1f, 2, radius, distance), what);
            Rays parallel = make_parallel_tiles({-0.31f, -0.27f, -0.93f}, 2 * size, 2);
            for (cpu::TraceRay& ray : parallel) ray.origin = ray.origin + from;
            expect_same(tracer, parallel, what + ", parallel");
        }
    }
}

TEST(ParallelBeam, rejects_negative_t_min) {
    const cpu::Tracer tracer = make_tracer(rock(), 4, Isa::best);
    Rays rays = make_parallel_tiles({0.3f, -0.2f, -1}, 2, 4);
    for (cpu::TraceRay& ray : rays)
        ray.origin = ray.origin + normalize(ray.direction) * 10.0f, ray.t_min = -12;
    EXPECT_GT(expect_same(tracer, rays, "all of them"), 1000u);
    for (size_t k = 0; k < rays.size(); ++k)
        if (k % 256 < 200) rays[k].t_min = 0;
    expect_same(tracer, rays, "the last of each tile");
}

TEST(ParallelBeam, finds_it_whatever_the_length_of_directions) {
    for (const float factor : {1e-20f, 1e-10f, 1e10f, 1e20f, 1e30f}) {
        const cpu::Tracer tracer = make_tracer(make_many_spaces(), 3, Isa::best);
        Rays rays = make_lens_tiles({1, 1.5f, 5}, {}, 0.3f, 6, 0.05f, 5);
        for (cpu::TraceRay& ray : rays) ray.direction = ray.direction * factor;
        expect_same(tracer, rays, "times " + std::to_string(factor));
    }
}

/// Rays to a sun from a surface and from another far behind it, and rays that go apart.
TEST(ParallelBeam, rejects_origins_that_lie_far_apart) {
    const cpu::Tracer tracer = make_tracer(rock(), 4, Isa::best);
    Rays scattered = make_parallel_tiles({0.3f, -0.2f, -1}, 2, 2);
    for (size_t k = 0; k < scattered.size(); k += 5)
        scattered[k].origin = scattered[k].origin + Vec3f{300, 20, 40};
    Rays wide = make_tiles({0, 0, 3}, {}, 3, 2);
    for (size_t k = 0; k < wide.size(); ++k) wide[k].origin.x += 1e-3f * float(k % 16);
    for (const Rays& rays : {scattered, wide}) {
        expect_same(tracer, rays, "apart");
        EXPECT_EQ(count_upper_nodes(tracer, rays, kBundle), count_upper_nodes(tracer, rays, 16));
    }
}

/// Of parallel rays all over an object, in any order: a beam about any 256 of them would hold all of it.
TEST(ParallelBeam, rejects_rays_in_no_order) {
    const cpu::Tracer tracer = make_tracer(rock(), 4, Isa::best);
    Rays rays = make_parallel_tiles({0, 0, -1}, 2, 4);
    std::shuffle(rays.begin(), rays.end(), std::mt19937(3));
    expect_same(tracer, rays, "shuffled");
    EXPECT_EQ(count_upper_nodes(tracer, rays, kBundle), count_upper_nodes(tracer, rays, 16));
}

TEST(ParallelBeam, a_ray_with_a_nan_hits_nothing_and_leaves_the_hits_of_others) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const Rays rays = make_lens_tiles({1.2f, 1.0f, 3.6f}, {}, 0.05f, 1, 0.02f, 3.5f);
    for (const Isa isa : machine_isas()) {
        const cpu::Tracer tracer = make_tracer(rock(), 2, isa);
        const Hits whole = trace(tracer, rays, 1);
        for (const float value : {std::nanf(""), kInfinity, -kInfinity, 1e30f})
            for (const size_t index : {size_t(0), size_t(21), size_t(143), size_t(255)})
                for (const bool is_direction : {false, true}) {
                    Rays broken = rays;
                    (is_direction ? broken[index].direction.y : broken[index].origin.y) = value;
                    // One that lies far off makes all of them no beam.
                    if (index > 64 && (is_direction || value != 1e30f))
                        EXPECT_LT(count_upper_nodes(tracer, broken, kBundle),
                                  count_upper_nodes(tracer, broken, 16));
                    Hits found = trace(tracer, broken, kBundle);
                    EXPECT_FALSE(found[index].is_hit());
                    found[index] = whole[index];
                    ASSERT_EQ(count_different(found, whole), 0u)
                        << int(isa) << ", " << value << ", ray " << index;
                }
    }
}

} // namespace

} // namespace relief
