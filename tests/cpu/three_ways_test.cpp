// The sample scenes, direct and tessellated: the same hits and the same depths, for each instruction set and
// without SIMD. (Brute force, the third way, is compared in tracer_test.cpp on meshes small enough for it.)
#include <gtest/gtest.h>

#include <cmath>

#include "cpu/tracer.h"
#include "math/vec.h"
#include "relief/samples.h"
#include "support/isas.h"

namespace relief {

namespace {

constexpr int kWidth = 192, kHeight = 108;

/// Rays through the pixel centres, in 4 x 4 blocks, so that packets are met.
std::vector<cpu::TraceRay> make_camera_rays(const Camera& camera) {
    const Vec3f forward = normalize(camera.to - camera.from), right = normalize(cross(forward, camera.up));
    const Vec3f up = cross(right, forward);
    const float half = std::tan(camera.fov_degrees * 3.14159265f / 360);
    std::vector<cpu::TraceRay> rays;
    for (int y = 0; y < kHeight; y += 4)
        for (int x = 0; x < kWidth; x += 4)
            for (int k = 0; k < 16; ++k) {
                const float sx = (2 * (float(x + k % 4) + 0.5f) / kWidth - 1) * half * kWidth / kHeight;
                const float sy = (1 - 2 * (float(y + k / 4) + 0.5f) / kHeight) * half;
                cpu::TraceRay ray;
                ray.origin = camera.from;
                ray.direction = normalize(forward + right * sx + up * sy);
                rays.push_back(ray);
            }
    return rays;
}

std::vector<cpu::TraceHit> trace(const std::shared_ptr<const PreparedScene>& scene,
                                 const RenderSettings& settings, const std::vector<cpu::TraceRay>& rays) {
    std::vector<cpu::TraceHit> hits(rays.size());
    cpu::Tracer(scene, settings).closest_hits(rays, hits);
    return hits;
}

void expect_same_hits(const Scene& scene, int level) {
    RenderSettings settings;
    settings.image.width = kWidth, settings.image.height = kHeight;
    settings.surface.level = level;
    const std::vector<cpu::TraceRay> rays = make_camera_rays(scene.camera);
    const auto direct = prepare_scene(scene, settings);
    settings.surface.mode = SurfaceMode::tessellated;
    const std::vector<cpu::TraceHit> reference = trace(prepare_scene(scene, settings), settings, rays);
    settings.surface.mode = SurfaceMode::direct;
    for (const Isa isa : test::machine_isas()) {
        settings.device.isa = isa;
        const std::vector<cpu::TraceHit> hits = trace(direct, settings, rays);
        size_t hit_count = 0, different = 0;
        for (size_t k = 0; k < rays.size(); ++k) {
            hit_count += hits[k].is_hit();
            different += hits[k].instance != reference[k].instance ||
                         (hits[k].is_hit() && std::fabs(hits[k].t - reference[k].t) > 1e-5f * reference[k].t);
        }
        EXPECT_EQ(different, 0u) << int(isa) << " level " << level;
        EXPECT_GT(hit_count, rays.size() / 10) << int(isa) << " level " << level;
    }
}

TEST(ThreeWays, pumpkin_is_the_same_direct_and_tessellated) {
    const Scene scene = make_sample_scene("pumpkin", Instancing::none);
    for (const int level : {3, 5}) expect_same_hits(scene, level);
}

TEST(ThreeWays, bark_is_the_same_direct_and_tessellated) {
    const Scene scene = make_sample_scene("bark", Instancing::none);
    for (const int level : {3, 4}) expect_same_hits(scene, level);
}

TEST(ThreeWays, smooth_bark_is_the_same_direct_and_tessellated) {
    Scene scene = make_sample_scene("bark", Instancing::none);
    for (const MapFilter filter : {MapFilter::cubic, MapFilter::bspline}) {
        for (Displacement& displacement : scene.displacements) displacement.filter = filter;
        for (const int level : {3, 4}) expect_same_hits(scene, level);
    }
}

} // namespace

} // namespace relief
