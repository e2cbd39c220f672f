// Rays from one point, traced as a bundle: the same hits, bit for bit, as sixteen at a time and one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <initializer_list>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "cpu/shading/shading_kernels.h"
#include "cpu/tracer.h"
#include "formulas/camera.h"
#include "math/affine.h"
#include "math/vec.h"
#include "prepare/camera_frame.h"
#include "support/isas.h"
#include "support/ray_tiles.h"

namespace relief {

namespace {

using namespace test;

/// One mesh, as it is.
Scene make_scene(const Mesh& mesh) {
    Scene scene;
    scene.materials.emplace_back();
    scene.meshes.push_back(mesh);
    Object object;
    object.name = mesh.name;
    scene.objects.push_back(object);
    return scene;
}

TEST(Bundle, finds_what_single_rays_find_at_every_level) {
    for (const Isa isa : test::machine_isas())
        for (const int level : {0, 1, 2, 3, 4, 5, 6, 7, 8, kAutoLevel}) {
            const cpu::Tracer tracer = make_tracer(rock(), level, isa);
            const size_t hits =
                expect_same(tracer, make_tiles({1.2f, 1.0f, 3.6f}, {}, 0.4f, 4),
                            "isa " + std::to_string(int(isa)) + ", level " + std::to_string(level));
            EXPECT_GT(hits, 1000u);
        }
}

TEST(Bundle, finds_it_from_inside_and_close_by_and_far_away) {
    for (const Isa isa : test::machine_isas()) {
        const cpu::Tracer tracer = make_tracer(rock(), 4, isa);
        const std::string name = "isa " + std::to_string(int(isa));
        EXPECT_GT(expect_same(tracer, make_tiles({0, 0, 0}, {0.3f, 0.2f, 1}, 1.5f, 4), name + ", inside"),
                  4000u);
        EXPECT_GT(expect_same(tracer, make_tiles({0, 0, 1.3f}, {0.5f, 0.3f, 0}, 1.0f, 4), name + ", close"),
                  500u);
        EXPECT_GT(expect_same(tracer, make_tiles({700, 30, 20}, {}, 0.002f, 4), name + ", far"), 500u);
        EXPECT_GT(expect_same(tracer, make_tiles({0, 4, 0}, {}, 0.5f, 2), name + ", along an axis"), 100u);
    }
}

TEST(Bundle, may_be_any_number_of_rays_with_limits_of_their_own) {
    const cpu::Tracer tracer = make_tracer(rock(), 4, Isa::best);
    Rays rays = make_tiles({1.2f, 1.0f, 3.6f}, {}, 0.3f, 2);
    std::mt19937 random(9);
    std::uniform_real_distribution<float> length(0, 12);
    for (cpu::TraceRay& ray : rays) {
        const float a = length(random), b = length(random);
        ray.t_min = std::min(a, b) * 0.5f, ray.t_max = std::max(a, b);
    }
    for (const size_t count : {63, 64, 65, 80, 100, 129, 200, 255, 256, 300, 1000})
        expect_same(tracer, Rays(rays.begin(), rays.begin() + long(count)), std::to_string(count) + " rays");
}

TEST(Bundle, finds_it_in_every_space) {
    const Scene scene = make_many_spaces();
    for (const Isa isa : test::machine_isas()) {
        const cpu::Tracer tracer = make_tracer(scene, 3, isa);
        EXPECT_GT(
            expect_same(tracer, make_tiles({1, 1.5f, 5}, {}, 0.8f, 6), "isa " + std::to_string(int(isa))),
            3000u);
        EXPECT_GT(expect_same(tracer, make_tiles({0, 9, 0.1f}, {}, 0.5f, 3), "from above"), 500u);
    }
}

/// Eight strips side by side, a hundred to thousands of times as long as they are far away, turned; and rays
/// that go close to where two of them join.
TEST(Bundle, finds_it_between_triangles_that_reach_far_aside) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (const float reach : {30.0f, 100.0f, 1000.0f, 4000.0f, 9000.0f})
        for (int turn = 0; turn < 12; ++turn) {
            const Vec3f forward = normalize(Vec3f{unit(random), unit(random), unit(random)});
            const Vec3f right = normalize(cross(forward, Vec3f{unit(random), unit(random), unit(random)}));
            const Vec3f up = cross(right, forward);
            Mesh strips;
            strips.name = "strips";
            for (int k = 0; k <= 8; ++k)
                for (const float y : {-reach, reach})
                    strips.positions.push_back(forward + right * (0.1f * float(k - 4)) + up * y);
            for (uint32_t k = 0; k < 8; ++k) {
                strips.face_sizes.push_back(4);
                for (const uint32_t corner : {2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1})
                    strips.position_indices.push_back(corner);
            }
            const Scene scene = make_scene(strips);
            Rays rays(256);
            for (size_t k = 0; k < rays.size(); ++k) {
                const float x = 0.1f * float(int(k % 7) - 3) + 2e-5f * unit(random);
                rays[k].direction = forward + right * x + up * (0.3f * unit(random));
            }
            const cpu::Tracer tracer = make_tracer(scene, 0, Isa::best);
            EXPECT_GT(expect_same(tracer, rays, "reach " + std::to_string(reach)), rays.size() / 2);
        }
}

/// Twenty squares in one place, and twenty more a little nearer: each ray meets all of them, and the first of
/// those that are as near as each other counts.
TEST(Bundle, finds_the_first_of_many_as_near_as_each_other) {
    Mesh pile;
    pile.name = "pile";
    for (const float z : {0.0f, 1e-3f}) {
        const uint32_t first = uint32_t(pile.positions.size());
        for (const Vec3f& p : {Vec3f{-1, -1, z}, Vec3f{1, -1, z}, Vec3f{1, 1, z}, Vec3f{-1, 1, z}})
            pile.positions.push_back(p);
        for (int k = 0; k < 20; ++k) {
            pile.face_sizes.push_back(4);
            for (uint32_t corner = 0; corner < 4; ++corner) pile.position_indices.push_back(first + corner);
        }
    }
    Scene scene = make_scene(pile);
    scene.objects.resize(3, scene.objects[0]);
    Affine& turned = scene.objects[1].world_from_object;
    turned.rows[0].x = turned.rows[1].y = -1;
    const Rays rays = make_tiles({0.1f, 0.2f, 3}, {}, 0.2f, 1);
    for (const Isa isa : test::machine_isas()) {
        const cpu::Tracer tracer = make_tracer(scene, 0, isa);
        EXPECT_EQ(expect_same(tracer, rays, "isa " + std::to_string(int(isa))), rays.size());
        for (const cpu::TraceHit& hit : trace(tracer, rays, kBundle)) {
            EXPECT_NE(hit.instance, 2u); // as the first one; the second may be nearer by a rounding
            EXPECT_EQ(hit.patch, 20u);
        }
    }
}

/// Four squares in one place are one block of eight triangles, which 256 rays meet 1,024 times: twice what is
/// taken note of at a time.
TEST(Bundle, finds_it_where_one_block_is_met_more_often_than_is_noted) {
    Mesh pile;
    pile.name = "pile";
    pile.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    for (int k = 0; k < 4; ++k) {
        pile.face_sizes.push_back(4);
        for (uint32_t corner = 0; corner < 4; ++corner) pile.position_indices.push_back(corner);
    }
    const Scene scene = make_scene(pile);
    const Rays rays = make_tiles({0.1f, 0.2f, 3}, {}, 0.2f, 1);
    for (const Isa isa : test::machine_isas())
        EXPECT_EQ(expect_same(make_tracer(scene, 0, isa), rays, std::to_string(int(isa))), rays.size());
}

/// Rays that meet edges, diagonals and corners of squares exactly, from both sides.
TEST(Bundle, finds_it_on_edges_and_corners) {
    Mesh squares;
    squares.name = "squares";
    for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x) squares.positions.push_back({float(x), float(y), 0});
    for (uint32_t y = 0; y < 4; ++y)
        for (uint32_t x = 0; x < 4; ++x) {
            const uint32_t first = 5 * y + x;
            squares.face_sizes.push_back(4);
            for (const uint32_t corner : {first, first + 1, first + 6, first + 5})
                squares.position_indices.push_back(corner);
        }
    const Scene scene = make_scene(squares);
    for (const Isa isa : test::machine_isas()) {
        const cpu::Tracer tracer = make_tracer(scene, 0, isa);
        for (const float side : {1.0f, -1.0f}) {
            Rays rays(256);
            for (size_t k = 0; k < rays.size(); ++k) {
                rays[k].origin = {0, 0, 8 * side};
                rays[k].direction = {0.25f * (float(k % 16) - 8) / 8, 0.25f * (float(k / 16) - 8) / 8, -side};
            }
            EXPECT_EQ(expect_same(tracer, rays, "side " + std::to_string(side)), rays.size());
        }
    }
}

TEST(Bundle, finds_the_same_triangles_on_a_tessellated_surface) {
    for (const Isa isa : test::machine_isas()) {
        const Rays rays = make_tiles({1.2f, 1.0f, 3.6f}, {}, 0.4f, 4);
        const cpu::Tracer tracer = make_tracer(rock(), 3, isa, SurfaceMode::tessellated);
        EXPECT_GT(expect_same(tracer, rays, "tessellated"), 1000u);
        const Hits direct = trace(make_tracer(rock(), 3, isa), rays, kBundle),
                   plain = trace(tracer, rays, kBundle);
        for (size_t k = 0; k < rays.size(); ++k) EXPECT_EQ(direct[k].t, plain[k].t) << "ray " << k;
    }
}

TEST(Bundle, works_without_room_for_trees) {
    for (const int level : {6, 7}) {
        RenderSettings settings;
        settings.image.width = 320, settings.image.height = 180, settings.surface.level = level;
        const Rays rays = make_tiles({1.2f, 1.0f, 3.6f}, {}, 0.4f, 3);
        const auto scene = prepare_scene(rock(), settings);
        const Hits with = trace(cpu::Tracer(scene, settings), rays, kBundle);
        settings.surface.cache_bytes = 0;
        EXPECT_EQ(count_different(with, trace(cpu::Tracer(scene, settings), rays, kBundle)), 0u);
    }
}

/// Field k of a ray: origin, t_min, direction, t_max.
float& get_field(cpu::TraceRay& ray, int k) {
    float* const fields[8] = {&ray.origin.x,    &ray.origin.y,    &ray.origin.z,    &ray.t_min,
                              &ray.direction.x, &ray.direction.y, &ray.direction.z, &ray.t_max};
    return *fields[k];
}

TEST(Bundle, a_ray_with_a_nan_hits_nothing_and_leaves_the_hits_of_others) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const Rays rays = make_tiles({1.2f, 1.0f, 3.6f}, {}, 0.2f, 1);
    for (const Isa isa : test::machine_isas()) {
        const cpu::Tracer tracer = make_tracer(rock(), 2, isa);
        const Hits whole = trace(tracer, rays, 1);
        for (int field = 0; field < 8; ++field)
            for (const float value : {std::nanf(""), kInfinity, -kInfinity})
                for (const size_t index : {size_t(0), size_t(21), size_t(143), size_t(255)}) {
                    Rays broken = rays;
                    get_field(broken[index], field) = value;
                    Hits found = trace(tracer, broken, kBundle);
                    const bool is_ray = field % 4 == 3;
                    if (!is_ray || std::isnan(value)) EXPECT_FALSE(found[index].is_hit());
                    found[index] = whole[index];
                    ASSERT_EQ(count_different(found, whole), 0u)
                        << int(isa) << ", field " << field << " is " << value << ", ray " << index;
                }
    }
}

/// Positions about the middle of a picture of 320 x 180, 16 to a row, some `step` pixels apart.
std::vector<Vec2f> list_positions(size_t count, float step) {
    std::mt19937 random(6);
    std::uniform_real_distribution<float> jitter(0, 1);
    std::vector<Vec2f> positions;
    for (size_t k = 0; k < count; ++k)
        positions.push_back({160 + step * (float(k % 16) - 8 + jitter(random)),
                             90 + step * (float(k / 16) - float(count / 32) + jitter(random))});
    return positions;
}

/// Hits of the camera against those of the rays that it writes, and those against the rays of aim_rays.
void expect_camera_hits(const cpu::Tracer& tracer, size_t count, const std::string& what, float step = 1) {
    const scalar::CameraFrame camera = make_camera_frame(tracer.scene());
    const std::vector<Vec2f> positions = list_positions(count, step);
    Rays aimed(count), written(count);
    tracer.shading_kernels().aim_rays(camera, positions.data(), count, aimed.data());
    Hits seen(count), seen_alone(count);
    tracer.camera_hits(camera, positions, written, seen);
    tracer.camera_hits(camera, positions, {}, seen_alone);
    EXPECT_EQ(std::memcmp(written.data(), aimed.data(), count * sizeof(cpu::TraceRay)), 0) << what;
    const Hits expected = trace(tracer, aimed, 1);
    EXPECT_EQ(count_different(seen, expected), 0u) << what;
    EXPECT_EQ(count_different(seen_alone, expected), 0u) << what << ", rays not written";
    const auto is_hit = [](const cpu::TraceHit& hit) { return hit.is_hit(); };
    if (count >= 300) EXPECT_GT(std::count_if(expected.begin(), expected.end(), is_hit), 30) << what;
}

TEST(CameraHits, are_those_of_the_rays_through_the_pixels) {
    for (const Isa isa : test::machine_isas()) {
        const cpu::Tracer one = make_tracer(rock(), 4, isa), many = make_tracer(make_many_spaces(), 3, isa);
        for (const size_t count : {1, 15, 16, 63, 64, 100, 255, 256, 257, 300, 1000}) {
            const std::string name = "isa " + std::to_string(int(isa)) + ", " + std::to_string(count);
            expect_camera_hits(one, count, name);
            expect_camera_hits(many, count, name + ", many spaces");
        }
    }
}

TEST(CameraHits, need_no_bundle) {
    Scene wide = rock();
    wide.camera.from = {0, 0, 0}, wide.camera.to = {0, 0.1f, 1};
    wide.camera.fov_degrees = 150; // rays of one bundle diverge too much
    expect_camera_hits(make_tracer(wide, 3, Isa::best), 320, "wide angle", 10);
    for (const auto& set : std::initializer_list<std::function<void(RenderSettings&)>>{
             [](RenderSettings& settings) { settings.surface.leaf = LeafKind::box; },
             [](RenderSettings& settings) { settings.surface.lod = LodRule::ray; },
             [](RenderSettings& settings) { settings.experiment.traversal = TraversalKind::stack; }}) {
        RenderSettings settings;
        settings.image.width = 320, settings.image.height = 180, settings.surface.level = 3;
        set(settings);
        const cpu::Tracer tracer(prepare_scene(rock(), settings), settings);
        const scalar::CameraFrame camera = make_camera_frame(tracer.scene());
        const std::vector<Vec2f> positions = list_positions(400, 1);
        Rays rays(positions.size());
        Hits seen(positions.size());
        tracer.camera_hits(camera, positions, rays, seen);
        const std::string name = "leaf " + std::to_string(int(settings.surface.leaf)) + ", lod " +
                                 std::to_string(int(settings.surface.lod)) + ", traversal " +
                                 std::to_string(int(settings.experiment.traversal));
        EXPECT_EQ(count_different(seen, trace(tracer, rays, rays.size())), 0u) << name;
        EXPECT_GT(count_different(seen, Hits(seen.size())), 30u) << name;
    }
}

} // namespace

} // namespace relief
