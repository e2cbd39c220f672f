// What a device keeps in fewer bits where they are enough: scenes for which they are not, beside the CPU
// engine.
#include <fmt/format.h>

#include "cast_fixture.h"
#include "math/affine.h"
#include "support/bodies.h"

namespace relief::vulkan::tests {

namespace {

class DeviceSceneTest : public GpuTest {
  protected:
    void expect_hits_of_cpu(const std::shared_ptr<const PreparedScene>& scene, const RenderSettings& settings,
                            uint32_t ray_count) {
        const std::vector<cpu::TraceRay> rays = make_rays(ray_count, 5);
        expect_same(cast_on_device(device(), *scene, settings, rays, {}), cast_on_cpu(scene, settings, rays),
                    rays);
    }
};

Displacement make_bumps(int edge) {
    return test::make_displacement(test::make_random_map(edge, edge, 0.01f, 9), DisplacementSpace::object);
}

TEST_F(DeviceSceneTest, numbers_more_vertices_than_sixteen_bits_count) {
    RenderSettings settings;
    settings.surface.level = 1;
    const auto scene =
        prepare_scene(test::make_body_scene(test::make_torus(300, 240), make_bumps(64)), settings);
    ASSERT_GT(scene->surfaces[0].vertex_count(), 0x10000u);
    expect_hits_of_cpu(scene, settings, 600);
}

TEST_F(DeviceSceneTest, keeps_levels_of_patches_above_seven) {
    RenderSettings settings;
    settings.surface.level = kAutoLevel;
    settings.image.width = 4000, settings.image.height = 4000;
    const auto scene =
        prepare_scene(test::make_body_scene(test::make_cube_sphere(2), make_bumps(2048)), settings);
    const LevelField& levels = *scene->instances[0].levels;
    ASSERT_GT(levels.max_level(), 7);
    ASSERT_FALSE(levels.is_uniform());
    expect_hits_of_cpu(scene, settings, 200);
}

/// Two quads share a texel, and so do the levels of two patches: where a surface ends in the middle of one,
/// the next begins a new one.
TEST_F(DeviceSceneTest, keeps_surfaces_of_an_odd_number_of_patches_apart) {
    RenderSettings settings;
    settings.surface.level = kAutoLevel;
    settings.image.width = 400, settings.image.height = 400;
    Scene source = test::make_body_scene(test::make_torus(5, 9), make_bumps(256));
    source.meshes.push_back(test::make_torus(3, 7));
    source.meshes.push_back(test::make_torus(7, 5));
    for (const uint32_t mesh : {1u, 2u}) {
        Object object = source.objects[0];
        object.name = fmt::format("body {}", mesh);
        object.mesh = mesh;
        object.world_from_object = make_scale({0.4f, 0.4f + 0.2f * float(mesh), 0.4f});
        if (mesh == 2) object.displacement = kNoIndex;
        source.objects.push_back(object);
    }
    const auto scene = prepare_scene(std::move(source), settings);
    ASSERT_EQ(scene->surfaces[0].patch_count() % 2, 1u);
    ASSERT_FALSE(scene->instances[0].levels->is_uniform());
    ASSERT_FALSE(scene->instances[1].levels->is_uniform());
    expect_hits_of_cpu(scene, settings, 1500);
}

/// A child's box, rounded outward, may begin before that of the node above it. Of ten thousands of rays that
/// come to one patch a round some have gone so far that they would take such a child's patches for tested
/// ones.
TEST_F(DeviceSceneTest, finds_hits_in_boxes_that_reach_out_of_those_above) {
    RenderSettings settings;
    settings.surface.level = 1;
    const auto scene =
        prepare_scene(test::make_body_scene(test::make_torus(60, 90),
                                            test::make_displacement(test::make_random_map(256, 256, 0.2f, 9),
                                                                    DisplacementSpace::object)),
                      settings);
    const std::vector<cpu::TraceRay> rays = make_rays(40000, 5);
    TracerConfig config;
    config.slots = 1;
    expect_same(cast_on_device(device(), *scene, settings, rays, config), cast_on_cpu(scene, settings, rays),
                rays);
}

} // namespace

} // namespace relief::vulkan::tests
