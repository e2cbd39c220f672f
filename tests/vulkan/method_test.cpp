// The render methods find the same hits, bit for bit.
#include <bit>

#include "cast_fixture.h"
#include "lab/scene_walks.h"
#include "relief/error.h"
#include "vulkan/path_tracer.h"
#include "vulkan/vulkan_engine.h"

namespace relief::vulkan::tests {
namespace {

const std::vector<std::string> kLayers{
    "depth",         "N",           "Ng", "P", "albedo", "uv", "id", "cost", "specular_direct",
    "light_default", "CryptoObject"};

RenderSettings make_method_settings() {
    RenderSettings settings;
    settings.device.engine = EngineKind::vulkan;
    settings.image.width = 48, settings.image.height = 32;
    settings.image.spp = 2, settings.image.bounces = 1;
    settings.image.layers = kLayers;
    return settings;
}

struct Picture {
    Image image;
    Statistics statistics;
};

Film make_film(const RenderSettings& settings, const PreparedScene& scene) {
    Film film(settings.image.width, settings.image.height, settings.image.crop, settings.image.layers);
    auto mattes = std::make_shared<InstanceMattes>();
    for (uint32_t k = 0; k < scene.instances.size(); ++k) mattes->objects.push_back(0x3f800000u + k);
    film.name_instances(std::move(mattes));
    return film;
}

/// On a validated device.
Picture render_with(RenderMethod method, const Scene& scene, RenderSettings settings) {
    settings.experiment.method = method;
    auto device = std::make_unique<Device>(
        Device::Config{.index = get_test_device_index(), .method = method, .is_validated = true});
    const Device& used = *device;
    const std::shared_ptr<const PreparedScene> prepared = prepare_scene(scene, settings);
    const std::unique_ptr<Engine> engine =
        make_engine_on(std::move(device), prepared, settings, make_device_walk(*prepared, settings));
    Film film = make_film(settings, *prepared);
    EXPECT_TRUE(engine->render(film, nullptr));
    Picture picture{film.resolve(), {}};
    engine->add_statistics(picture.statistics);
    for (const std::string& message : used.validation_messages()) ADD_FAILURE() << message;
    return picture;
}

void expect_same_bits(const Image& a, const Image& b) {
    ASSERT_EQ(a.pixels.size(), b.pixels.size());
    size_t other = 0;
    for (size_t k = 0; k < a.pixels.size(); ++k)
        other += std::bit_cast<uint32_t>(a.pixels[k]) != std::bit_cast<uint32_t>(b.pixels[k]);
    EXPECT_EQ(other, 0u) << "of " << a.pixels.size() << " values";
}

size_t count_hits(const Image& image) {
    const size_t depth = image.find_channel("depth.Z").value();
    size_t count = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) count += std::isfinite(image.at(x, y, depth));
    return count;
}

/// A change to the scene and settings that all begin with.
struct MethodCase {
    const char* name;
    void (*change)(Scene& scene, RenderSettings& settings);
};

/// Grazing and near: patches of many levels, and of different ones along their edges.
void use_many_levels(Scene& scene, RenderSettings& settings) {
    scene.camera.from = {1.35f, 0.3f, 0.2f};
    scene.camera.to = {0.4f, 1.1f, 0};
    settings.surface.pixel_error = 0.5f;
}

/// Above level 5, and more than one wave has room for.
void use_tiles(Scene&, RenderSettings& settings) { settings.surface.level = 6; }

/// The camera is inside the displaced body and a mirrored plain one, whose polygons reach behind it.
void use_surroundings(Scene& scene, RenderSettings& settings) {
    scene.camera.from = {0.05f, 0.02f, 0};
    scene.camera.to = {1, 0.3f, 0.4f};
    scene.camera.fov_degrees = 100;
    scene.objects[2].world_from_object = make_scale({-7, 5, 6});
    scene.objects[0].world_from_object =
        compose(make_rotation_degrees({10, 30, 5}), make_scale({0.4f, 0.4f, -0.02f}));
    settings.surface.level = 3;
    settings.image.crop = {3, 5, 46, 31};
}

void use_polygons_alone(Scene&, RenderSettings& settings) {
    settings.surface.mode = SurfaceMode::tessellated;
    settings.surface.level = 2;
}

/// Before and behind the body, seen by cameras over a background.
void use_visible_lights(Scene& scene, RenderSettings& settings) {
    settings.image.background = Vec3f{0.1f, 0.1f, 0.1f};
    for (const LightType type : {LightType::point, LightType::rectangle, LightType::disk, LightType::spot}) {
        Light light;
        light.type = type, light.radius = 0.4f, light.strength = 3, light.is_visible_to_camera = true;
        const float place = float(scene.lights.size());
        light.position = {1.5f - place, 1.2f - 0.5f * place, place < 2 ? 2.0f : -2.0f};
        light.direction = scene.camera.from - light.position;
        scene.lights.push_back(light);
    }
}

class Methods : public testing::TestWithParam<MethodCase> {};

INSTANTIATE_TEST_SUITE_P(Scenes, Methods,
                         testing::Values(MethodCase{"as_it_is", [](Scene&, RenderSettings&) {}},
                                         MethodCase{"many_levels", use_many_levels},
                                         MethodCase{"tiles", use_tiles},
                                         MethodCase{"surroundings", use_surroundings},
                                         MethodCase{"polygons_alone", use_polygons_alone},
                                         MethodCase{"visible_lights", use_visible_lights}),
                         [](const auto& info) { return info.param.name; });

TEST_P(Methods, find_the_same_bits) {
    Scene scene = make_scene(DisplacementSpace::tangent);
    RenderSettings settings = make_method_settings();
    GetParam().change(scene, settings);
    const Picture expected = render_with(RenderMethod::compute, scene, settings);
    EXPECT_GT(count_hits(expected.image), 200u);
    for (const RenderMethod method : {RenderMethod::fragment, RenderMethod::hybrid}) {
        const Picture found = render_with(method, scene, settings);
        expect_same_bits(found.image, expected.image);
        EXPECT_EQ(found.statistics.camera_rays, expected.statistics.camera_rays);
        EXPECT_EQ(found.statistics.shadow_rays, expected.statistics.shadow_rays);
        EXPECT_EQ(found.statistics.bounce_rays, expected.statistics.bounce_rays);
    }
}

/// The four pairs of Sousa et al. 2019, by each of their methods.
TEST(PairsOfStructureAndTraversal, make_one_picture_by_every_method) {
    const Scene scene = make_scene(DisplacementSpace::tangent);
    RenderSettings settings = make_method_settings();
    settings.image.spp = 1;
    const Picture expected = render_with(RenderMethod::compute, scene, settings);
    const std::pair<StructureKind, TraversalKind> pairs[] = {
        {StructureKind::kdtree, TraversalKind::push_down},
        {StructureKind::kdtree, TraversalKind::backtrack},
        {StructureKind::bvh, TraversalKind::restart_trail},
        {StructureKind::bvh, TraversalKind::parent_link}};
    for (const auto& [structure, traversal] : pairs) {
        settings.experiment.structure = structure, settings.experiment.traversal = traversal;
        for (const RenderMethod method :
             {RenderMethod::compute, RenderMethod::fragment, RenderMethod::hybrid})
            expect_same_bits(render_with(method, scene, settings).image, expected.image);
    }
}

class HybridMethod : public testing::Test {
  protected:
    /// One device and many ways to use it.
    static const Device& device() {
        static const Device device(
            {.index = get_test_device_index(), .method = RenderMethod::hybrid, .is_validated = true});
        return device;
    }
    void TearDown() override {
        for (const std::string& message : device().validation_messages()) ADD_FAILURE() << message;
    }
};

TEST_F(HybridMethod, draws_the_same_picture_again_and_in_small_batches) {
    RenderSettings settings = make_method_settings();
    settings.experiment.method = RenderMethod::hybrid;
    settings.image.crop = {2, 1, 45, 30};
    const auto prepared = prepare_scene(make_scene(DisplacementSpace::object), settings);
    const DeviceScene device_scene(device(), *prepared);
    const auto trace = [&](uint32_t rays) {
        Tracer tracer(device(), *prepared, device_scene, settings,
                      {.ray_capacity = rays, .pair_capacity = 3000});
        PathTracer paths(tracer, settings);
        Film film = make_film(settings, *prepared);
        constexpr uint64_t kPixels = 43 * 29;
        for (uint64_t first = 0; first < kPixels; first += paths.capacity()) {
            const PixelRange range{film.window(), first,
                                   std::min<uint64_t>(paths.capacity(), kPixels - first)};
            paths.trace_samples(film, {&range, 1}, {0, 2});
        }
        return film.resolve();
    };
    const Image whole = trace(4096);
    expect_same_bits(trace(4096), whole);
    expect_same_bits(trace(346), whole);
}

TEST_F(HybridMethod, refuses_a_window_larger_than_the_device_draws) {
    RenderSettings settings = make_method_settings();
    settings.experiment.method = RenderMethod::hybrid;
    const uint32_t most = device().max_draw_size();
    if (most >= uint32_t(kMaxPictureSize)) GTEST_SKIP() << "no picture is too large";
    settings.image.width = int(most) + 1, settings.image.height = 1;
    settings.image.layers.clear();
    auto own = std::make_unique<Device>(
        Device::Config{.index = get_test_device_index(), .method = settings.experiment.method});
    const std::unique_ptr<Engine> engine = make_engine_on(
        std::move(own), prepare_scene(make_scene(DisplacementSpace::object), settings), settings);
    Film film(settings.image.width, settings.image.height, settings.image.crop, settings.image.layers);
    try {
        engine->render(film, nullptr);
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        EXPECT_NE(error.hint().find("image.crop"), std::string::npos) << error.what();
    }
}

} // namespace
} // namespace relief::vulkan::tests
