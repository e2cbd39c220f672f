// Paths inside closed displaced bodies whose materials send rays on: behind cut-outs, through glass, under
// coats. Outside is light; one ray that gets there shows. RELIEF_LEAK_RAYS sets how many rays in all.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <ostream>

#include "cpu/leak_rays.h"
#include "math/affine.h"
#include "support/bodies.h"
#include "support/shading_scenes.h"

namespace relief {
namespace {

constexpr int kSize = 64;
/// A path of four bounces inside a closed body: a camera ray, four bounces, a shadow ray at each of five
/// vertices.
constexpr uint64_t kRaysAPath = 10;

/// At most one in so many rays may start beyond the neighbour of its triangle, in a crease narrower than the
/// error of its position: docs/results/leaks.md. A usual run has fewer rays, which must all hit.
constexpr uint64_t kRaysAnOutsider = 50000000;

Material make_coated() {
    Material m = make_matte(0.8f);
    m.ior = 1.5f, m.roughness = 0.3f, m.base_diffuse_roughness = 0.5f;
    m.coat_weight = 1, m.coat_roughness = 0.1f, m.fuzz_weight = 0.4f;
    return m;
}

Material make_cut_out(float opacity) {
    Material m = make_matte(0.8f);
    set_input_texture(m, MaterialInput::opacity, make_number_texture(opacity));
    return m;
}

Material make_glass_walls(float roughness, bool is_thin_walled = false) {
    Material m;
    m.roughness = roughness, m.transmission_weight = 1, m.is_thin_walled = is_thin_walled;
    return m;
}

struct PathLeakCase {
    const char* name;
    Material shell;
    Material inner;
};

void PrintTo(const PathLeakCase& c, std::ostream* stream) { *stream << c.name; }

const PathLeakCase kPathLeakCases[] = {
    {"coat", make_coated(), make_coated()},
    {"cut_outs", make_cut_out(1), make_cut_out(0.5f)},
    {"clear_glass", make_matte(0.8f), make_glass_walls(0)},
    {"rough_glass", make_matte(0.8f), make_glass_walls(0.3f)},
    {"thin_walls", make_cut_out(1), make_glass_walls(0, true)},
};

Displacement make_bumps(DisplacementSpace space) {
    return test::make_displacement(test::make_random_map(96, 64, 0.12f, 21), space);
}

/// A closed shell, a body in it, the camera between both and near the shell, so that levels differ; light
/// around all of it.
Scene make_shell_scene(const PathLeakCase& c) {
    Scene scene = test::make_body_scene(test::make_cube_sphere(4), make_bumps(DisplacementSpace::tangent));
    scene.displacements.push_back(make_bumps(DisplacementSpace::object));
    scene.materials = {c.shell, c.inner};
    scene.objects[0].material = 0;
    Object inner = scene.objects[0];
    inner.name = "inner", inner.displacement = 1, inner.material = 1;
    inner.world_from_object = compose(make_rotation_degrees({20, 35, 50}), make_scale({0.5f, 0.4f, 0.45f}));
    scene.objects.push_back(inner);
    scene.environment = Environment{};
    scene.lights.push_back({.type = LightType::sun, .direction = {-1, -2, -1}, .angle_degrees = 5});
    scene.camera.from = {0.7f, 0.1f, 0.2f}, scene.camera.to = {0, 0, 0}, scene.camera.fov_degrees = 100;
    return scene;
}

RenderSettings make_settings(uint64_t rays) {
    RenderSettings settings = make_small_settings(kSize, int(rays / (kSize * kSize * kRaysAPath)) + 1, 4);
    settings.surface.pixel_error = 3; // coarse enough that the view decides the levels
    return settings;
}

uint64_t count_lit_pixels(const Image& image) {
    uint64_t count = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            count += image.at(x, y, 0) != 0 || image.at(x, y, 1) != 0 || image.at(x, y, 2) != 0;
    return count;
}

class PathLeakTest : public testing::TestWithParam<PathLeakCase> {};

TEST_P(PathLeakTest, no_path_from_inside_meets_the_light_outside) {
    const uint64_t rays = test::leak_ray_count() / std::size(kPathLeakCases);
    const RenderResult result = render(make_shell_scene(GetParam()), make_settings(rays));
    const Statistics& s = result.statistics;
    EXPECT_GE(s.camera_rays + s.shadow_rays + s.bounce_rays, rays / 2);
    EXPECT_LE(count_lit_pixels(result.image), rays / kRaysAnOutsider);
}

/// What tells the shell from one with a hole, by the same settings.
TEST_P(PathLeakTest, light_is_seen_through_a_hole_of_one_face) {
    Scene scene = make_shell_scene(GetParam());
    Mesh open = scene.meshes[0];
    open.face_sizes.pop_back();
    open.position_indices.resize(open.position_indices.size() - 4);
    open.uv_indices.resize(open.uv_indices.size() - 4);
    scene.objects[1].mesh = 1; // the inner body stays closed
    scene.meshes = {open, scene.meshes[0]};
    const Image image = render(std::move(scene), make_settings(200000)).image;
    EXPECT_GT(*std::max_element(image.pixels.begin(), image.pixels.end()), 0.0f);
}

/// One sample a pixel of the body alone in a white furnace: what a single path can bring.
TEST_P(PathLeakTest, no_path_in_a_furnace_brings_much_more_than_its_light) {
    const PathLeakCase& c = GetParam();
    Scene scene = make_shell_scene(c);
    scene.objects.erase(scene.objects.begin());
    scene.lights.clear();
    scene.camera.from = {0.2f, 0.4f, 1.6f}, scene.camera.fov_degrees = 40;
    RenderSettings settings = make_small_settings(512, 1, 32);
    double sum = 0;
    float highest = 0;
    int bright = 0;
    const Image image = render(std::move(scene), settings).image;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const float value = image.at(x, y, 1);
            ASSERT_TRUE(std::isfinite(value)) << x << ", " << y;
            sum += double(value), highest = std::max(highest, value);
            bright += value > 4 ? 1 : 0;
        }
    EXPECT_LE(sum / (512.0 * 512), 1.01);
    EXPECT_LE(bright, 2) << "of 262,144 paths, whose facets may each weigh a little more than 1";
    EXPECT_LE(highest, 8.0f);
}

INSTANTIATE_TEST_SUITE_P(Materials, PathLeakTest, testing::ValuesIn(kPathLeakCases),
                         [](const testing::TestParamInfo<PathLeakCase>& info) {
                             return std::string(info.param.name);
                         });

} // namespace
} // namespace relief
