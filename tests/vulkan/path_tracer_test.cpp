// Whole paths on the device: the same samples as the CPU engine's, however the picture is cut.
#include <cmath>

#include "cpu/cpu_engine.h"
#include "support/all_layers.h"
#include "support/many_lights.h"
#include "vulkan/path_tracer.h"
#include "vulkan/shading_fixture.h"

namespace relief::vulkan::tests {
namespace {

const std::vector<std::string> kAllLayers = test::list_all_layers("light_default");

/// Lights in groups by turns, each with a layer.
void add_light_groups(Scene& scene, std::vector<std::string>& layers) {
    const auto add = [&](std::string& group, const char* name) {
        group = name;
        layers.push_back(std::string("light_") + name);
    };
    if (scene.environment) add(scene.environment->light_group, "sky");
    for (size_t k = 0; k < scene.lights.size(); ++k)
        if (k % 3 != 0) add(scene.lights[k].light_group, k % 3 == 1 ? "one" : "two");
    for (size_t k = 0; k < scene.materials.size(); k += 3)
        if (!(scene.materials[k].emission == Vec3f{})) add(scene.materials[k].light_group, "lamp");
}

RenderSettings make_path_settings() {
    RenderSettings settings;
    settings.image.width = 32, settings.image.height = 24;
    settings.image.spp = 4, settings.image.bounces = 4, settings.surface.pixel_error = 4;
    settings.image.first_sample = 2, settings.image.seed = 8;
    settings.image.crop = {3, 2, 30, 23};
    settings.image.layers = kAllLayers;
    settings.device.threads = 2;
    return settings;
}

/// A change to the scene and settings that all tests begin with.
struct Variant {
    const char* name;
    void (*change)(Scene& scene, RenderSettings& settings);
};

void use_constant_environment(Scene& scene, RenderSettings&) {
    scene.lights.clear();
    scene.environment->texture = nullptr;
    for (Material& material : scene.materials) material.emission = {};
}

void use_emitters_alone(Scene& scene, RenderSettings& settings) {
    scene.lights.clear();
    scene.environment.reset();
    settings.surface.level = 2;
}

void use_nothing_to_draw(Scene& scene, RenderSettings& settings) {
    use_emitters_alone(scene, settings);
    for (Material& material : scene.materials) material.emission = {};
    scene.environment.emplace().strength = 0;
}

void use_direct_light_alone(Scene&, RenderSettings& settings) { settings.image.bounces = 0; }

void use_clamped_indirect_light(Scene&, RenderSettings& settings) { settings.image.clamp_indirect = 0.02f; }

void use_long_paths(Scene& scene, RenderSettings& settings) {
    settings.image.bounces = 12;
    for (Material& material : scene.materials) material.roughness = 0.1f, material.metallic = 1;
}

/// A spot, a disk and a rectangle, before the camera too.
void use_shaped_lights(Scene& scene, RenderSettings& settings) {
    use_emitters_alone(scene, settings);
    Light rectangle, disk, spot;
    rectangle.type = LightType::rectangle, rectangle.position = {-2, 1.5f, 2.5f};
    rectangle.direction = {0.5f, -0.6f, 0.5f}, rectangle.width = 1.5f, rectangle.strength = 20;
    disk.type = LightType::disk, disk.position = {2, 3, 1}, disk.direction = {-1, -2, 1};
    disk.radius = 0.7f, disk.strength = 25;
    spot.type = LightType::spot, spot.position = {0, 2.5f, 4}, spot.direction = {0.1f, -1, -0.9f};
    spot.cone_degrees = 70, spot.blend = 0.6f, spot.radius = 0.3f, spot.strength = 40;
    scene.lights = {rectangle, disk, spot};
    for (Light& light : scene.lights) light.is_visible_to_camera = true;
    spot.radius = 0, spot.position = {-3, 2, 2}, spot.direction = {1, -0.8f, -0.5f}, spot.strength = 15;
    scene.lights.push_back(spot);
}

void use_shaped_lights_over_a_background(Scene& scene, RenderSettings& settings) {
    use_shaped_lights(scene, settings);
    settings.image.background = Vec3f{0.1f, 0.2f, 0.3f};
    scene.materials[2].opacity = 0.4f; // the floor lets lights through that are below it
    scene.lights[0].position.y = -2.5f, scene.lights[0].direction = {0, 0.2f, 1};
}

void use_textured_lights(Scene& scene, RenderSettings& settings) {
    use_shaped_lights(scene, settings);
    scene.lights[0].color_texture = make_colors(5, 3, 2, 6);
    scene.lights[1].color_texture = make_half_greys(4, 4), scene.lights[1].up = {1, 0.5f, 0};
}

/// More than are listed: they come into the light tree, and emissive surfaces with them.
void use_many_lights(Scene& scene, RenderSettings&) {
    const std::vector<Light> lamps = make_many_lights(60, 4, 5);
    scene.lights.insert(scene.lights.end(), lamps.begin(), lamps.end());
    for (size_t k = 4; k < scene.lights.size(); ++k) {
        Light& light = scene.lights[k];
        light.is_visible_to_camera = k % 3 == 0 && light.radius > 0;
    }
}

void use_linked_lights(Scene& scene, RenderSettings&) {
    for (size_t k = 0; k < scene.objects.size(); ++k) scene.objects[k].name = std::string(1, char('a' + k));
    scene.lights[0].link_includes = {"a", "d"}, scene.lights[1].link_excludes = {"a"};
    scene.lights[2].link_includes = {"c"};
}

void use_many_linked_lights(Scene& scene, RenderSettings& settings) {
    use_many_lights(scene, settings);
    use_linked_lights(scene, settings);
    for (size_t k = 4; k < scene.lights.size(); k += 2)
        (k % 4 == 0 ? scene.lights[k].link_includes : scene.lights[k].link_excludes) = {"c", "b"};
}

/// Whose corners, as those of the sphere, are far apart.
void use_low_levels(Scene& scene, RenderSettings& settings) {
    settings.surface.level = 1;
    scene.displacements[0].autobump = false;
}

/// A floor of layers, before it lights that are seen, above it a cut-out.
void use_shadow_catchers(Scene& scene, RenderSettings& settings) {
    use_shaped_lights(scene, settings);
    settings.image.background = Vec3f{};
    scene.environment.emplace();
    scene.objects[2].is_shadow_catcher = true;
    scene.materials[0].opacity = 0.5f;
}

void use_cut_outs(Scene& scene, RenderSettings&) {
    float opacity = 0.3f;
    for (Material& material : scene.materials)
        if (material.emission == Vec3f{}) material.opacity = opacity, opacity = 1.2f - opacity;
    set_input_texture(scene.materials.front(), MaterialInput::opacity, make_half_greys(8, 5),
                      MapFilter::cubic);
}

/// A rough body that absorbs, one of a part of glass, and a clear wall as floor; lights before and behind it.
void use_glass(Scene& scene, RenderSettings& settings) {
    settings.image.bounces = 8;
    Material& body = scene.materials.at(0);
    body.transmission_weight = 1, body.roughness = 0.3f, body.metallic = 0, body.ior = 1.4f;
    set_input_texture(body, MaterialInput::metallic, nullptr);
    body.transmission_color = {0.9f, 0.5f, 0.3f}, body.transmission_depth = 0.7f;
    Material& wall = scene.materials.at(2);
    wall.coat_weight = wall.fuzz_weight = 0;
    wall.transmission_weight = 0.9f, wall.is_thin_walled = true, wall.roughness = 0.03f;
    wall.transmission_color = {0.5f, 1, 0.8f};
    Material mixed = body;
    mixed.transmission_weight = 0.6f, mixed.metallic = 0.3f, mixed.transmission_depth = 0;
    set_input_texture(mixed, MaterialInput::normal, nullptr); // the sphere has no uvs
    mixed.is_thin_walled = true, mixed.base_diffuse_roughness = 0.5f, mixed.specular_weight = 0.8f;
    add_object(scene, make_sphere(4, SphereNormals::smooth), mixed);
    scene.objects.back().world_from_object =
        compose(make_translation({1, 1.2f, 2}), make_scale({0.6f, 0.6f, 0.6f}));
    Light light;
    light.type = LightType::point, light.position = {0, -3, 1}, light.radius = 0.5f, light.strength = 30;
    light.is_visible_to_camera = true;
    scene.lights.push_back(light);
}

class PathTracerTest : public GpuTest {
  protected:
    explicit PathTracerTest(const Variant& variant = {"", [](Scene&, RenderSettings&) {}}) {
        Scene scene = make_shading_scene();
        variant.change(scene, settings_);
        add_light_groups(scene, settings_.image.layers);
        prepared_ = prepare_scene(std::move(scene), settings_);
    }

    struct Picture {
        Image image;
        Statistics statistics;
    };

    Film make_film() const {
        Film film(settings_.image.width, settings_.image.height, settings_.image.crop,
                  settings_.image.layers);
        auto mattes = std::make_shared<InstanceMattes>();
        for (const relief::Instance& instance : prepared_->instances) {
            mattes->objects.push_back(0x3f800000u + (uint32_t(mattes->objects.size()) << 20));
            mattes->materials.push_back(0x3f800000u + (instance.material << 20));
        }
        film.name_instances(std::move(mattes));
        return film;
    }

    Picture trace_on_device(uint32_t ray_capacity, int samples_a_call,
                            uint32_t pair_capacity = 1u << 16) const {
        const DeviceScene device_scene(device(), *prepared_);
        Tracer tracer(device(), *prepared_, device_scene, settings_,
                      {.ray_capacity = ray_capacity, .pair_capacity = pair_capacity});
        PathTracer path_tracer(tracer, settings_);
        Film film = make_film();
        const uint64_t pixels = 27 * 21;
        for (int k = 0; k < settings_.image.spp; k += samples_a_call) {
            const SampleRange samples{settings_.image.first_sample + k, samples_a_call};
            for (uint64_t first = 0, count = 100; first < pixels; first += count, count = pixels - first) {
                count = std::min<uint64_t>(count, path_tracer.capacity());
                const PixelRange range{film.window(), first, count};
                path_tracer.trace_samples(film, {&range, 1}, samples);
            }
        }
        Picture picture{film.resolve(), {}};
        path_tracer.add_statistics(picture.statistics);
        return picture;
    }

    Picture trace_on_cpu() const {
        Film film = make_film();
        const std::unique_ptr<Engine> engine = make_cpu_engine(prepared_, settings_);
        engine->render(film, nullptr);
        Picture picture{film.resolve(), {}};
        engine->add_statistics(picture.statistics);
        return picture;
    }

    RenderSettings settings_ = make_path_settings();
    std::shared_ptr<const PreparedScene> prepared_;
};

class PathTracerVariants : public PathTracerTest, public testing::WithParamInterface<Variant> {
  protected:
    PathTracerVariants() : PathTracerTest(GetParam()) {}
};

INSTANTIATE_TEST_SUITE_P(
    Scenes, PathTracerVariants,
    testing::Values(
        Variant{"with_everything", [](Scene&, RenderSettings&) {}},
        Variant{"in_a_constant_environment", use_constant_environment},
        Variant{"with_emitters_alone", use_emitters_alone}, Variant{"in_the_dark", use_nothing_to_draw},
        Variant{"with_shaped_lights", use_shaped_lights},
        Variant{"with_shaped_lights_over_a_background", use_shaped_lights_over_a_background},
        Variant{"with_many_lights", use_many_lights}, Variant{"with_textured_lights", use_textured_lights},
        Variant{"with_linked_lights", use_linked_lights},
        Variant{"with_many_linked_lights", use_many_linked_lights},
        Variant{"with_direct_light_alone", use_direct_light_alone},
        Variant{"with_clamped_indirect_light", use_clamped_indirect_light},
        Variant{"at_low_levels", use_low_levels}, Variant{"with_shadow_catchers", use_shadow_catchers},
        Variant{"with_cut_outs", use_cut_outs}, Variant{"with_glass", use_glass},
        Variant{"with_long_paths", use_long_paths}),
    [](const auto& info) { return info.param.name; });

TEST_P(PathTracerVariants, takes_the_samples_of_the_cpu_engine) {
    const Picture device = trace_on_device(4096, 4), cpu = trace_on_cpu();
    ASSERT_EQ(device.image.channels, cpu.image.channels);
    const size_t channels = cpu.image.channels.size();
    for (size_t c = 0; c < channels; ++c) {
        size_t in_channel = 0;
        for (size_t k = c; k < cpu.image.pixels.size(); k += channels) {
            const float a = device.image.pixels[k], b = cpu.image.pixels[k];
            in_channel += !(a == b || std::fabs(a - b) <= 0.01f * std::max(1.0f, std::fabs(b)));
        }
        // A ray that grazes an edge may hit on one engine only, and its path diverges.
        EXPECT_LE(in_channel, 12u) << cpu.image.channels[c];
    }
    EXPECT_EQ(device.statistics.camera_rays, cpu.statistics.camera_rays);
    const auto expect_close = [](uint64_t a, uint64_t b) {
        EXPECT_NEAR(double(a), double(b), 0.01 * double(b));
    };
    expect_close(device.statistics.bounce_rays, cpu.statistics.bounce_rays);
    expect_close(device.statistics.shadow_rays, cpu.statistics.shadow_rays);
}

TEST_F(PathTracerTest, gives_the_same_picture_however_it_is_cut) {
    const Picture whole = trace_on_device(2048, 4), cut = trace_on_device(300, 4);
    EXPECT_EQ(whole.image.pixels, cut.image.pixels);
    EXPECT_EQ(whole.statistics.shadow_rays, cut.statistics.shadow_rays);
    // Different summation order in single precision.
    const Picture by_sample = trace_on_device(2048, 1);
    ASSERT_EQ(by_sample.image.pixels.size(), whole.image.pixels.size());
    for (size_t k = 0; k < whole.image.pixels.size(); ++k) {
        const float a = by_sample.image.pixels[k], b = whole.image.pixels[k];
        ASSERT_TRUE(a == b || std::fabs(a - b) <= 2e-5f * std::max(1.0f, std::fabs(b))) << k;
    }
}

TEST_F(PathTracerTest, gives_the_same_bits_again_and_in_any_form) {
    const Picture expected = trace_on_device(4096, 4);
    EXPECT_EQ(trace_on_device(4096, 4).image.pixels, expected.image.pixels);
    EXPECT_EQ(trace_on_device(4096, 4, 1200).image.pixels, expected.image.pixels) << "many chunks";
    settings_.surface.cache_bytes = 0;
    EXPECT_EQ(trace_on_device(4096, 4).image.pixels, expected.image.pixels) << "no cache";
    settings_.experiment.bottom = BottomForm::fused;
    EXPECT_EQ(trace_on_device(4096, 4).image.pixels, expected.image.pixels) << "fused, no cache";
    settings_.surface.cache_bytes = 1;
    EXPECT_EQ(trace_on_device(4096, 4).image.pixels, expected.image.pixels) << "fused, small cache";
}

TEST_F(PathTracerTest, counts_rays_by_kind_and_depth) {
    const Picture picture = trace_on_device(4096, 4);
    const Statistics& statistics = picture.statistics;
    uint64_t camera = 0, bounce = 0, shadow = 0;
    for (const CastStatistics& cast : statistics.casts) {
        EXPECT_LE(cast.depth, settings_.image.bounces + 1);
        (cast.is_shadow ? shadow : cast.depth == 0 ? camera : bounce) += cast.rays;
    }
    EXPECT_EQ(camera, uint64_t(27 * 21 * settings_.image.spp));
    EXPECT_EQ(camera, statistics.camera_rays);
    EXPECT_EQ(bounce, statistics.bounce_rays);
    EXPECT_EQ(shadow, statistics.shadow_rays);
    EXPECT_GT(bounce, 0u);
    EXPECT_GT(shadow, 0u);
}

} // namespace
} // namespace relief::vulkan::tests
