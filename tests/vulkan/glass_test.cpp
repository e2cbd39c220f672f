// A small displaced body of glass: both engines agree within their noise.
#include "cpu/cpu_engine.h"
#include "support/z_test.h"
#include "vulkan/path_tracer.h"
#include "vulkan/shading_fixture.h"

namespace relief::vulkan::tests {
namespace {

class GlassPictures : public GpuTest {};

TEST_F(GlassPictures, of_a_displaced_body_agree_by_their_noise) {
    Material glass;
    glass.transmission_weight = 1, glass.roughness = 0.15f;
    glass.transmission_color = {0.9f, 0.6f, 0.4f}, glass.transmission_depth = 1;
    Scene scene;
    add_displaced(scene, test::make_cube_sphere(3), DisplacementSpace::tangent, Affine{}, glass);
    add_object(scene, make_floor(4), make_matte(0.6f));
    scene.objects.back().world_from_object = make_translation({0, -1.3f, 0});
    add_lights(scene);
    scene.camera.from = {0, 1.5f, 5};
    RenderSettings settings = make_small_settings(16, 32, 8);
    const auto prepared = prepare_scene(scene, settings);
    const DeviceScene device_scene(device(), *prepared);
    Tracer tracer(device(), *prepared, device_scene, settings, {.ray_capacity = 4096});
    PathTracer path_tracer(tracer, settings);
    Film film(16, 16, settings.image.crop, settings.image.layers);
    const PixelRange range{film.window(), 0, 16 * 16};
    path_tracer.trace_samples(film, {&range, 1}, {0, 32});
    settings.image.seed = 99; // other samples: those of one seed agree far better
    Film other(16, 16, settings.image.crop, settings.image.layers);
    make_cpu_engine(prepared, settings)->render(other, nullptr);
    const auto blocks = compute_block_means(film.resolve(), 4),
               expected = compute_block_means(other.resolve(), 4);
    EXPECT_LT(compute_largest_z(blocks, expected), 4.5) << print_block_means(blocks);
}

} // namespace
} // namespace relief::vulkan::tests
