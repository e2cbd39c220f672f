// Sample scenes by both engines through the public calls, every instance validated. `relief-gpu parity`
// compares more, at a size that takes longer.
#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "gpu/parity.h"
#include "relief/intersect.h"
#include "relief/samples.h"

namespace relief::gpu {
namespace {

struct Variant {
    const char* name;
    int level = kAutoLevel;
    LeafKind leaf = LeafKind::exact;
    BottomForm bottom = BottomForm::split;
    size_t cache_bytes = size_t(256) << 20;
};

const Variant kVariants[] = {
    {.name = "auto"},
    {.name = "auto, fused, boxes, no cache",
     .leaf = LeafKind::box,
     .bottom = BottomForm::fused,
     .cache_bytes = 0},
    {.name = "level 3, fused", .level = 3, .bottom = BottomForm::fused},
    {.name = "level 4, boxes", .level = 4, .leaf = LeafKind::box},
    {.name = "level 5, no cache", .level = 5, .cache_bytes = 0},
    {.name = "level 6", .level = 6},
};

/// A scene, and whether its instances share their meshes.
struct Subject {
    const char* scene;
    Instancing instancing = Instancing::none;
};

class Samples : public testing::TestWithParam<Subject> {
  protected:
    /// Made once for all tests of the process.
    static const Scene& scene() {
        static std::map<std::pair<std::string, Instancing>, Scene> scenes;
        const auto [place, is_new] = scenes.try_emplace({GetParam().scene, GetParam().instancing});
        if (is_new) place->second = make_sample_scene(GetParam().scene, GetParam().instancing);
        return place->second;
    }

    static RenderSettings make_settings() {
        RenderSettings settings;
        settings.image.width = 96, settings.image.height = 54;
        settings.image.spp = 1, settings.image.bounces = 0;
        settings.image.layers = {"depth", "id"};
        return settings;
    }

    static Image render_by(EngineKind engine, RenderSettings settings) {
        settings.device.engine = engine;
        if (engine == EngineKind::cpu) settings.experiment.bottom = BottomForm::automatic;
        return render(scene(), settings).image;
    }
};

TEST_P(Samples, are_hit_where_the_cpu_engine_hits_them) {
    for (const Variant& variant : kVariants) {
        RenderSettings settings = make_settings();
        settings.surface.level = variant.level, settings.surface.leaf = variant.leaf;
        settings.experiment.bottom = variant.bottom, settings.surface.cache_bytes = variant.cache_bytes;
        const HitDifference found =
            compare_hits(render_by(EngineKind::vulkan, settings), render_by(EngineKind::cpu, settings));
        // Of 5184 pixels none may differ.
        EXPECT_LE(found.share(), kLargestShare) << variant.name;
        EXPECT_LE(found.largest_depth_difference, kLargestDepthDifference) << variant.name;
    }
}

TEST_P(Samples, have_the_means_of_other_samples_by_the_cpu_engine) {
    RenderSettings settings = make_settings();
    settings.image.width = 48, settings.image.height = 27;
    settings.image.spp = 48, settings.image.bounces = 3;
    settings.image.layers = {"variance"};
    const Image found = render_by(EngineKind::vulkan, settings);
    settings.image.seed = 1;
    EXPECT_LE(compute_largest_z(found, render_by(EngineKind::cpu, settings)), kLargestZ);
}

TEST_P(Samples, answer_the_rays_of_other_programs_alike) {
    RenderSettings settings = make_settings();
    settings.surface.level = 4;
    std::vector<Ray> rays;
    const Camera& camera = scene().camera;
    for (int k = 0; k < 2000; ++k) {
        Ray ray;
        ray.origin = camera.from;
        const float a = 0.3f * (float(k % 50) / 25 - 1), b = 0.3f * (float(k / 50) / 20 - 1);
        ray.direction = {camera.to.x - camera.from.x + a, camera.to.y - camera.from.y + b,
                         camera.to.z - camera.from.z - a};
        rays.push_back(ray);
    }
    std::map<EngineKind, std::vector<RayHit>> hits;
    std::map<EngineKind, std::vector<uint8_t>> any;
    for (const EngineKind engine : {EngineKind::cpu, EngineKind::vulkan}) {
        settings.device.engine = engine;
        const Intersector intersector(
            scene(), {settings.surface, settings.device, settings.experiment, settings.image.height});
        hits[engine].resize(rays.size()), any[engine].resize(rays.size());
        intersector.closest_hits(rays, hits[engine]);
        intersector.any_hits(rays, any[engine]);
    }
    EXPECT_EQ(any[EngineKind::cpu], any[EngineKind::vulkan]);
    EXPECT_GT(std::count(any[EngineKind::cpu].begin(), any[EngineKind::cpu].end(), 1), 100);
    for (size_t k = 0; k < rays.size(); ++k) {
        const RayHit &a = hits[EngineKind::cpu][k], &b = hits[EngineKind::vulkan][k];
        ASSERT_EQ(a.object, b.object) << k;
        ASSERT_EQ(a.patch, b.patch) << k;
        if (a.object != kNoIndex) ASSERT_NEAR(a.t, b.t, 1e-5f * a.t) << k;
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Samples,
                         testing::Values(Subject{"pumpkin"}, Subject{"ear"}, Subject{"bark"},
                                         Subject{"barks"}, Subject{"barks", Instancing::shared},
                                         Subject{"materials", Instancing::shared}),
                         [](const auto& info) {
                             const bool is_shared = info.param.instancing == Instancing::shared;
                             return std::string(info.param.scene) + (is_shared ? "_shared" : "");
                         });

} // namespace
} // namespace relief::gpu
