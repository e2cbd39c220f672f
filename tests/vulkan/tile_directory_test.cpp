// Tile directories requested after others have been built.
#include "cast_fixture.h"
#include "vulkan/layout/device_rays.h"

namespace relief::vulkan::tests {

namespace {

class TileDirectoriesTest : public GpuTest {};

/// One at each tile of a cube's faces, too short to reach any other face: the directories of the first faces
/// are all that the first rays ask for.
std::vector<cpu::TraceRay> make_rays_at_tiles() {
    std::vector<cpu::TraceRay> rays;
    for (int face = 0; face < 6; ++face)
        for (int tile = 0; tile < 4; ++tile) {
            const float side = face % 2 ? 3.0f : -3.0f;
            const float a = tile % 2 ? 0.3f : -0.3f, b = tile / 2 ? 0.25f : -0.25f;
            const Vec3f origins[] = {{side, a, b}, {a, side, b}, {a, b, side}};
            const Vec3f directions[] = {{-side, 0, 0}, {0, -side, 0}, {0, 0, -side}};
            cpu::TraceRay ray;
            ray.origin = origins[face / 2], ray.direction = directions[face / 2];
            ray.t_max = 0.9f;
            rays.push_back(ray);
        }
    return rays;
}

TEST_F(TileDirectoriesTest, made_later_join_those_that_are_there) {
    RenderSettings settings;
    settings.surface.level = 6;
    const std::shared_ptr<const PreparedScene> scene =
        prepare_scene(test::make_body_scene(test::make_cube_sphere(1),
                                            test::make_displacement(test::make_random_map(32, 32, 0.02f, 3),
                                                                    DisplacementSpace::object)),
                      settings);
    const std::vector<cpu::TraceRay> rays = make_rays_at_tiles();
    const CpuAnswers expected = cast_on_cpu(scene, settings, rays);
    const DeviceScene device_scene(device(), *scene);
    TracerConfig config;
    config.ray_capacity = uint32_t(rays.size());
    Tracer tracer(device(), *scene, device_scene, settings, config);
    std::vector<scalar::RayData> data;
    std::vector<uint32_t> numbers;
    for (const cpu::TraceRay& ray : rays) {
        numbers.push_back(uint32_t(numbers.size()));
        data.push_back({ray.origin, ray.t_min, ray.direction, ray.t_max, ray.lod_bias});
    }
    tracer.rays().upload(data);
    // Sixteen tiles make a buffer with room for eight more, which are added where it is.
    for (const auto& [first, count] : {std::pair(0u, 16u), std::pair(16u, 8u)}) {
        Buffer list(device(), {"ray list", count * sizeof(uint32_t), Purpose::ray_buffers});
        list.upload(std::as_bytes(std::span(numbers).subspan(first, count)));
        tracer.closest_hits(list, count);
    }
    const std::vector<scalar::HitData> hits = tracer.hits().download<scalar::HitData>(rays.size());
    for (size_t k = 0; k < rays.size(); ++k) {
        ASSERT_TRUE(expected.closest[k].is_hit()) << "ray " << k;
        EXPECT_EQ(expected.closest[k].patch, expected.closest[k / 4 * 4].patch) << "ray " << k;
        EXPECT_EQ(hits[k].instance, 0u) << "ray " << k;
        EXPECT_EQ(hits[k].patch_index, expected.closest[k].patch) << "ray " << k;
        EXPECT_NEAR(hits[k].t, expected.closest[k].t, 1e-6f) << "ray " << k;
    }
}

} // namespace

} // namespace relief::vulkan::tests
