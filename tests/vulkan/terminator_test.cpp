// Where light ends on coarse smooth surfaces: a device shows what the CPU engine shows.
#include <gtest/gtest.h>

#include "gpu_fixture.h"
#include "support/coarse_sphere.h"

namespace relief::vulkan::tests {
namespace {

RenderSettings make_settings(int size, int spp, int level) {
    RenderSettings settings = make_small_settings(size, spp, 0);
    settings.surface.level = level;
    return settings;
}

Image render_on_device(Scene scene, RenderSettings settings) {
    settings.device.engine = EngineKind::vulkan;
    settings.device.index = get_test_device_index();
    return render(std::move(scene), settings).image;
}

Scene make_flat(Mesh mesh) { return test::make_flat_displaced(std::move(mesh), SubdivisionScheme::none); }

TEST(DeviceTerminator, coarse_spheres_fade_as_on_the_cpu_engine) {
    struct Case {
        Scene scene;
        int level;
    };
    const Case cases[] = {{test::make_sphere_scene(test::make_icosphere(1)), kAutoLevel},
                          {test::make_displaced_sphere(), 1},
                          {make_flat(test::make_icosphere(1)), kAutoLevel},
                          {make_flat(test::make_quad_sphere(3)), kAutoLevel},
                          {make_flat(test::make_quad_sphere(2)), 1}};
    for (const Light& light : {test::make_sun_at_right(), test::make_rectangle_at_right()})
        for (auto [scene, level] : cases) {
            test::aim_at_sphere(scene, light);
            const Image image = render_on_device(scene, make_settings(32, 4, level));
            const Image same = render(scene, make_settings(32, 4, level)).image;
            size_t other = 0, black = 0, lit = 0;
            for (int y = 0; y < 32; ++y)
                for (int x = 0; x < 32; ++x) {
                    const float a = image.at(x, y, 1), b = same.at(x, y, 1);
                    other += !(std::fabs(a - b) <= 1e-3f * (1 + b));
                    lit += b > 0, black += b > 0.01f && a == 0;
                }
            EXPECT_GT(lit, 80u);
            EXPECT_EQ(black, 0u) << level;
            EXPECT_LE(other, 8u) << level; // rays at an edge may hit on one engine only
        }
}

} // namespace
} // namespace relief::vulkan::tests
