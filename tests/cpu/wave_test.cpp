// Paths of several samples that advance together give what those of one sample at a time give.
#include <gtest/gtest.h>

#include <random>

#include "cpu/path_tracer.h"
#include "cpu/ray_order.h"
#include "prepare/light_sources.h"
#include "support/strides.h"

namespace relief::cpu {

namespace {

std::shared_ptr<const PreparedScene> prepare_torus(const RenderSettings& settings, float aperture) {
    Scene scene = test::make_textured_torus(3, SampleType::float16, MapFilter::none);
    scene.camera.aperture_radius = aperture, scene.camera.focus_distance = 3;
    Material glass;
    glass.transmission_weight = 1, glass.roughness = 0.1f;
    scene.materials.push_back(glass);
    scene.materials[0].opacity = 0.7f;
    Object ball = scene.objects[0];
    ball.name = "glass", ball.material = 1;
    ball.world_from_object.translation = {0.3f, 0.6f, 0.2f};
    scene.objects.push_back(ball);
    Light light;
    light.type = LightType::point, light.position = {2, 3, 1}, light.radius = 0.3f;
    scene.lights.push_back(light);
    return prepare_scene(std::move(scene), settings);
}

RenderSettings make_settings() {
    RenderSettings settings = test::make_session_settings();
    settings.image.width = 40, settings.image.height = 24, settings.image.bounces = 4,
    settings.image.spp = 21;
    settings.image.layers = {"depth", "N", "albedo", "P", "uv", "id", "variance", "cost"};
    return settings;
}

TEST(Waves, of_many_samples_give_those_of_one) {
    RenderSettings settings = make_settings();
    for (const float aperture : {0.0f, 0.2f}) {
        const auto prepared = prepare_torus(settings, aperture);
        const Tracer tracer(prepared, settings);
        const LightSet lights(tracer);
        const PathTracerScene scene{tracer, lights, settings};
        const auto make_film = [&] {
            return Film(settings.image.width, settings.image.height, settings.image.crop,
                        settings.image.layers);
        };
        Film together = make_film(), apart = make_film();
        TileReport report;
        for (const int x : {0, 16, 32}) {
            const Window tile{x, 3, std::min(x + 16, settings.image.width), 19};
            trace_tile(scene, together, tile, {2, 21}, report);
            for (int k = 2; k < 23; ++k) trace_tile(scene, apart, tile, {k, 1}, report);
        }
        EXPECT_TRUE(together.resolve().pixels == apart.resolve().pixels) << aperture;
    }
}

TEST(ScatteredRays, are_traced_in_any_order) {
    RenderSettings settings = make_settings();
    const auto prepared = prepare_torus(settings, 0);
    const Tracer tracer(prepared, settings);
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    std::vector<TraceRay> rays(5000);
    for (TraceRay& ray : rays) {
        ray.origin = {normal(random), normal(random), normal(random)};
        ray.direction = {normal(random), normal(random), normal(random)};
        ray.lod_bias = random() % 2 * 2;
    }
    rays[7].direction = {}, rays[8].direction = {NAN, 1, 0}, rays[9].direction = {INFINITY, 0, 1};
    rays[10].direction = {0, 0, -1}, rays[11].direction = {-3e38f, 3e38f, 3e38f};
    for (const size_t count : {size_t(0), size_t(100), rays.size()}) {
        const std::span<const TraceRay> some = std::span(rays).first(count);
        RayOrder order;
        std::vector<TraceHit> hits(count), expected(count);
        std::vector<uint8_t> occluded(count), expected_occluded(count);
        closest_scattered_hits(tracer, some, hits, 0, order);
        tracer.closest_hits(some, expected);
        for (size_t k = 0; k < count; ++k) {
            EXPECT_EQ(hits[k].t, expected[k].t) << k;
            EXPECT_EQ(hits[k].patch, expected[k].patch) << k;
        }
        std::vector<uint32_t> places = order.places;
        EXPECT_EQ(std::ranges::is_sorted(places), count < 256) << "few are left as they are";
        std::ranges::sort(places);
        for (uint32_t k = 0; k < count; ++k) ASSERT_EQ(places.at(k), k);
        any_scattered_hits(tracer, some, occluded, 0, order);
        tracer.any_hits(some, expected_occluded);
        EXPECT_EQ(occluded, expected_occluded);
    }
}

} // namespace

} // namespace relief::cpu
