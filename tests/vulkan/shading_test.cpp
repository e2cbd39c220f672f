// Each kernel of the path tracer beside the CPU engine, on the same paths and hits.
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "cpu/shading/terminator.h"
#include "formulas/basis.h"
#include "formulas/bsdf.h"
#include "formulas/camera.h"
#include "formulas/constants.h"
#include "formulas/light.h"
#include "formulas/path.h"
#include "formulas/pixel_order.h"
#include "formulas/sobol.h"
#include "prepare/camera_frame.h"
#include "vulkan/shading_fixture.h"

#include "vulkan/layout/device_paths.h"
#include "vulkan/layout/device_rays.h"

namespace relief::vulkan::tests {
namespace {

constexpr uint32_t kCount = ShadingBench::kCount;
/// Allowed number of cases whose comparisons of close values may go either way.
constexpr uint32_t kAllowedFlips = kCount / 500;

/// Largest difference of components, relative above 1.
float compare(const Vec3f& a, const Vec3f& b) {
    const Vec3f d = a - b;
    const float scale = std::max({1.0f, std::fabs(b.x), std::fabs(b.y), std::fabs(b.z)});
    const float worst = std::max({std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)}) / scale;
    return is_finite(a) ? worst : INFINITY;
}

std::string describe(const Vec3f& v) { return fmt::format("({:.9g} {:.9g} {:.9g})", v.x, v.y, v.z); }

std::string describe(const scalar::RayData& ray) {
    return fmt::format("ray {} + [{:.9g}, {:.9g}] {} bias {}", describe(ray.origin), ray.t_min, ray.t_max,
                       describe(ray.direction), ray.lod_bias);
}

/// A case and what the device and the CPU engine made of it.
template <class T> std::string describe(uint32_t k, const T& device, const T& cpu) {
    return fmt::format("case {}: {} for {}", k, describe(device), describe(cpu));
}

/// A case in which only one of them has a light or a bounce.
std::string describe_choice(const char* what, uint32_t k, bool is_of_device) {
    return fmt::format("case {}: a {} of the {} alone", k, what, is_of_device ? "device" : "CPU engine");
}

std::string describe(const ShadingCase& c) {
    return fmt::format("instance {} patch {} levels {:x} cell {} {} {} at {:.9g} {:.9g}, seen along {}",
                       c.hit.instance, c.hit.patch, c.hit.levels, c.hit.i, c.hit.j, c.hit.is_upper, c.hit.u,
                       c.hit.v, describe(c.ray.direction));
}

/// Cases in which the device went another way than the CPU engine.
class Flips {
  public:
    /// `ways`: both of them; of the first cases they are kept.
    void add(const ShadingCase& c, const std::string& ways) {
        if (++count_ <= kKept) text_ += "\n" + ways + "; " + describe(c);
    }
    uint32_t count() const { return count_; }
    const std::string& text() const { return text_; }

  private:
    static constexpr uint32_t kKept = 12;
    uint32_t count_ = 0;
    std::string text_;
};

class ShadingKernels : public GpuTest {
  protected:
    static void SetUpTestSuite() {
        RenderSettings settings;
        settings.image.width = 64, settings.image.height = 48, settings.surface.pixel_error = 4,
        settings.image.bounces = 6;
        bench_ =
            std::make_unique<ShadingBench>(device(), prepare_scene(make_shading_scene(), settings), settings);
        cases_ = make_cases(*bench_->prepared);
        for (const ShadingCase& c : cases_) vertices_.push_back(make_vertex(bench_->tracer, c));
    }
    static void TearDownTestSuite() {
        bench_.reset();
        cases_.clear();
        vertices_.clear();
    }

    static ShadingBench& bench() { return *bench_; }
    static void make_points(uint32_t depth) {
        bench_->upload(cases_);
        bench_->run("surface_point", bench_->make_push(depth));
        bench_->run("shading_normal", bench_->make_push(depth));
    }
    static Vec2f draw_pair(const ShadingCase& c, const scalar::PathPush& push, uint32_t kind) {
        return scalar::draw_bounce_pair(c.path.pixel_seed, push.sample_index, push.depth, kind);
    }

    static inline std::unique_ptr<ShadingBench> bench_;
    static inline std::vector<ShadingCase> cases_;
    static inline std::vector<CpuVertex> vertices_;
};

TEST_F(ShadingKernels, start_the_camera_rays_of_listed_pixels) {
    scalar::CameraPush push{make_camera_frame(*bench().prepared), 7, 3, 19, 40, 5, 512, 9, 4};
    std::vector<uint32_t> pixels;
    for (uint32_t k = 0; k < push.count; ++k) {
        const scalar::PixelPlace place = scalar::place_pixel(5 + k, 19, 40);
        pixels.push_back(scalar::pack_pixel(7 + place.x, 3 + place.y));
    }
    bench().shadow_list.upload(pixels);
    bench().run("camera", push);
    const auto rays = bench().rays.download<scalar::RayData>(push.count);
    const auto paths = bench().paths.download<scalar::PathData>(push.count);
    for (uint32_t k = 0; k < push.count; ++k) {
        const scalar::PixelPlace place = scalar::place_pixel(5 + k, 19, 40);
        const uint32_t x = 7 + place.x, y = 3 + place.y;
        const uint32_t seed = scalar::make_pixel_seed(4, x, y);
        ASSERT_EQ(paths[k].pixel_seed, seed);
        const scalar::CameraRay ray =
            scalar::start_camera_ray(push.camera, {float(x), float(y)}, seed, push.sample_index);
        ASSERT_LT(compare(rays[k].origin, ray.origin), 1e-5f) << k;
        ASSERT_LT(compare(rays[k].direction, ray.direction), 1e-5f) << k;
        ASSERT_TRUE(std::isinf(rays[k].t_max) && rays[k].lod_bias == 0);
        ASSERT_EQ(compare(paths[k].throughput, {1, 1, 1}), 0);
    }
}

TEST_F(ShadingKernels, make_the_surface_points_of_the_cpu_engine) {
    make_points(1);
    const auto points = bench().points.download<scalar::SurfacePointData>(kCount);
    for (uint32_t k = 0; k < kCount; ++k) {
        const CpuVertex& v = vertices_[k];
        const scalar::SurfacePointData& point = points[k];
        SCOPED_TRACE(describe(cases_[k]));
        ASSERT_LE(compare(point.position, v.point.position), v.point.position_error)
            << describe(k, point.position, v.point.position);
        ASSERT_LT(compare(point.geometric_normal, v.point.geometric_normal), 1e-4f)
            << describe(k, point.geometric_normal, v.point.geometric_normal);
        ASSERT_LT(compare(point.bent_normal, v.basis.n), 2e-3f) << describe(k, point.bent_normal, v.basis.n);
        ASSERT_LT(compare(point.base_color, v.material.base_color), 1e-4f)
            << describe(k, point.base_color, v.material.base_color);
        ASSERT_NEAR(point.roughness, v.material.roughness, 1e-4f) << k;
        ASSERT_NEAR(point.metallic, v.material.metallic, 1e-4f) << k;
        ASSERT_NEAR(point.area_per_uv, v.point.area_per_uv, 1e-3f * v.point.area_per_uv) << k;
        ASSERT_NEAR(point.position_error / v.point.position_error, 1, 1e-4f) << k;
        ASSERT_EQ(point.is_flipped != 0, v.is_flipped) << k;
    }
}

TEST_F(ShadingKernels, sum_up_first_hits_in_the_film) {
    bench().commands.fill(bench().film, 0, kCount * sizeof(scalar::FilmSumsData), 0);
    make_points(0);
    make_points(0);
    bench().run("film", bench().make_push(0));
    const auto film = bench().film.download<scalar::FilmSumsData>(kCount);
    for (uint32_t k = 0; k < kCount; ++k) {
        const CpuVertex& v = vertices_[k];
        SCOPED_TRACE(describe(cases_[k]));
        ASSERT_EQ(film[k].hit_count, 2);
        ASSERT_LT(compare(film[k].shading_normal * 0.5f, v.point.shading_normal), 2e-3f)
            << describe(k, film[k].shading_normal * 0.5f, v.point.shading_normal);
        ASSERT_LT(compare(film[k].geometric_normal * 0.5f, v.point.geometric_normal), 1e-4f)
            << describe(k, film[k].geometric_normal * 0.5f, v.point.geometric_normal);
        ASSERT_LT(compare(film[k].position * 0.5f, v.point.position), 1e-5f) << k;
        ASSERT_LT(compare(film[k].albedo * 0.5f, v.material.base_color), 1e-4f) << k;
        ASSERT_NEAR(film[k].uv.x * 0.5f, v.point.uv.x, 1e-5f) << k;
        ASSERT_NEAR(film[k].uv.y * 0.5f, v.point.uv.y, 1e-5f) << k;
        ASSERT_EQ(film[k].depth, cases_[k].hit.t) << k;
        ASSERT_EQ(film[k].id, cases_[k].hit.instance + 1) << k;
        ASSERT_EQ(film[k].cost, cases_[k].path.cost) << k;
    }
}

TEST_F(ShadingKernels, gather_the_light_that_rays_meet) {
    std::vector<ShadingCase> cases = cases_;
    for (uint32_t k = 0; k < kCount; ++k) {
        if (k % 3 != 0) cases[k].hit = {}; // nothing
        if (k % 5 == 0) cases[k].ray.direction = normalize(Vec3f{2, 3, 1} - cases[k].path.previous);
        if (k % 5 == 1) cases[k].ray.direction = normalize(Vec3f{-1.02f, 2, -0.5f});
    }
    for (uint32_t depth : {0u, 1u}) {
        bench().upload(cases);
        bench().run("background", bench().make_push(depth));
        const auto paths = bench().paths.download<scalar::PathData>(kCount);
        Flips flips;
        for (uint32_t k = 0; k < kCount; ++k) {
            const ShadingCase& c = cases[k];
            const cpu::LightSet& lights = bench().cpu_lights;
            cpu::EnvironmentLookup behind;
            lights.look_up_environment({&c.ray.direction, 1}, {&behind, 1});
            Vec3f expected{};
            if (depth > 0)
                expected = c.path.throughput *
                           lights.evaluate_mis(
                               {{c.path.previous, {}, 0}, c.ray.direction, c.hit.t, c.path.bsdf_pdf}, behind);
            else if (!c.hit.is_hit())
                expected = behind.radiance;
            if (!(compare(paths[k].radiance, expected) < 2e-3f))
                flips.add(c, describe(k, paths[k].radiance, expected));
        }
        EXPECT_LE(flips.count(), kAllowedFlips) << "depth " << depth << flips.text();
    }
}

/// What the CPU engine's light sampling brings; nothing where it draws none.
struct ExpectedLight {
    scalar::RayData ray;
    Vec3f contribution;
};

std::optional<ExpectedLight> expect_light(const ShadingBench& bench, const ShadingCase& c, const CpuVertex& v,
                                          const cpu::LightSet::RandomNumbers& random) {
    const cpu::LightSet::Receiver at{v.point.position, c.hit.lod_bias, v.point.geometric_normal,
                                     v.point.instance};
    cpu::LightSample light;
    const uint32_t first = 0;
    bench.cpu_lights.draw({&at, 1}, {&random, 1}, {&light, 1});
    PatchSamplesCache patches;
    const Vec3f& normal = v.point.geometric_normal;
    const float lift =
        light.pdf > 0 ? find_light_lift(*bench.prepared, c.hit, v.point, {light.direction, normal}, patches)
                      : 0.0f;
    if (!(light.pdf > 0) || (dot(light.direction, normal) <= 0 && lift == 0)) return std::nullopt;
    bench.cpu_lights.complete_weight({&light, 1}, {&first, 1});
    const scalar::BsdfValue bsdf = v.evaluate(scalar::to_local(v.basis, light.direction));
    const Vec3f contribution = c.path.throughput * bsdf.value * light.weight *
                               (lift > 0 ? 1 : scalar::power_heuristic(light.pdf, bsdf.pdf));
    if (contribution == Vec3f{} || !is_finite(contribution)) return std::nullopt;
    if (lift > 0) // the way up, at first
        return ExpectedLight{
            {v.point.position + normal * v.point.position_error, 0, normal, lift, c.hit.lod_bias},
            contribution};
    const Vec3f origin = bench.tracer.offset_origin(v.point, light.direction);
    scalar::RayData ray{origin, 0, light.direction, light.distance, c.hit.lod_bias};
    if (light.emitter) {
        const Vec3f to = bench.tracer.offset_origin(*light.emitter, -light.direction) - ray.origin;
        ray.t_max = length(to);
        ray.direction = normalize(to);
    }
    return ExpectedLight{ray, contribution};
}

bool is_like(const scalar::RayData& a, const scalar::RayData& b) {
    const bool same_end =
        std::isinf(b.t_max) ? std::isinf(a.t_max) : std::fabs(a.t_max - b.t_max) < 1e-3f * b.t_max;
    return compare(a.origin, b.origin) < 1e-4f && compare(a.direction, b.direction) < 1e-3f && same_end &&
           a.t_min == b.t_min && a.lod_bias == b.lod_bias;
}

TEST_F(ShadingKernels, draw_the_lights_that_the_cpu_engine_draws) {
    make_points(2);
    const scalar::PathPush push = bench().make_push(2);
    bench().commands.fill(bench().counters, 0, sizeof(scalar::CounterData), 0);
    bench().run("light_sample_terminators", push);
    const auto paths = bench().paths.download<scalar::PathData>(kCount);
    const auto rays = bench().rays.download<scalar::RayData>(2 * kCount);
    const uint32_t count = bench().counters.download<scalar::CounterData>(1)[0].shadow_count;
    std::vector<uint8_t> is_drawn(kCount, 0);
    for (uint32_t ray : bench().shadow_list.download<uint32_t>(count)) is_drawn.at(ray - kCount) += 1;
    Flips flips;
    uint32_t drawn_count = 0;
    for (uint32_t k = 0; k < kCount; ++k) {
        const Vec2f pick = draw_pair(cases_[k], push, scalar::kPickPair);
        const Vec2f u = draw_pair(cases_[k], push, scalar::kLightPair);
        const Vec2f last = draw_pair(cases_[k], push, scalar::kRoulettePair);
        const auto expected = expect_light(bench(), cases_[k], vertices_[k], {pick.x, last.y, u});
        drawn_count += expected ? 1 : 0;
        ASSERT_LE(is_drawn[k], 1);
        if (!expected || is_drawn[k] == 0) {
            if (expected.has_value() != (is_drawn[k] == 1))
                flips.add(cases_[k], describe_choice("light", k, is_drawn[k] == 1));
            continue;
        }
        const float scale = length(expected->contribution);
        const bool is_same =
            compare(paths[k].contribution * (1 / scale), expected->contribution * (1 / scale)) < 2e-2f &&
            is_like(rays[kCount + k], expected->ray);
        if (!is_same)
            flips.add(cases_[k], describe(k, paths[k].contribution, expected->contribution) + ", " +
                                     describe(k, rays[kCount + k], expected->ray));
        ASSERT_EQ(paths[k].cost, 2) << k;
    }
    EXPECT_LE(flips.count(), kAllowedFlips) << flips.text();
    EXPECT_GT(drawn_count, kCount / 3);
}

TEST_F(ShadingKernels, weigh_the_emission_of_surfaces_that_were_met) {
    for (uint32_t depth : {0u, 1u}) {
        make_points(depth);
        bench().run("meet_surface", bench().make_push(depth));
        const auto paths = bench().paths.download<scalar::PathData>(kCount);
        Flips flips;
        uint32_t glowing = 0;
        for (uint32_t k = 0; k < kCount; ++k) {
            const ShadingCase& c = cases_[k];
            const float light_pdf =
                depth > 0 ? bench().cpu_lights.emitter_pdf({c.path.previous, {}, 0}, vertices_[k].point)
                          : 0.0f;
            const float weight = depth > 0 ? scalar::power_heuristic(c.path.bsdf_pdf, light_pdf) : 1.0f;
            const Vec3f expected = c.path.throughput * vertices_[k].material.emission * weight;
            if (!(compare(paths[k].radiance, expected) < 5e-3f))
                flips.add(c, describe(k, paths[k].radiance, expected));
            glowing += expected != Vec3f{};
        }
        EXPECT_LE(flips.count(), kAllowedFlips) << "depth " << depth << flips.text();
        EXPECT_GT(glowing, kCount / 3);
    }
}

struct ExpectedBounce {
    Vec3f throughput;
    scalar::RayData ray;
};

std::optional<ExpectedBounce> expect_bounce(const ShadingBench& bench, const ShadingCase& c,
                                            const CpuVertex& v, const scalar::PathPush& push) {
    const auto draw = [&](uint32_t kind) {
        return scalar::draw_bounce_pair(c.path.pixel_seed, push.sample_index, push.depth, kind);
    };
    const scalar::BsdfSample drawn = v.sample(draw(scalar::kPickPair).y, draw(scalar::kBsdfPair));
    const Vec3f direction = normalize(scalar::from_local(v.basis, drawn.direction));
    if (drawn.weight == Vec3f{} || dot(v.point.geometric_normal, direction) <= 0) return std::nullopt;
    const Vec3f throughput = c.path.throughput * drawn.weight;
    const float probability = scalar::survival_probability(push.depth, throughput);
    if (!is_finite(throughput) || draw(scalar::kRoulettePair).x >= probability) return std::nullopt;
    const Vec3f origin = bench.tracer.offset_origin(v.point, direction);
    return ExpectedBounce{throughput * (1 / probability),
                          {origin, 0, direction, scalar::make_infinity(), c.hit.lod_bias}};
}

TEST_F(ShadingKernels, bounce_where_the_cpu_engine_bounces) {
    for (uint32_t depth : {1u, 4u}) {
        make_points(depth);
        const scalar::PathPush push = bench().make_push(depth);
        bench().commands.fill(bench().counters, 0, sizeof(scalar::CounterData), 0);
        bench().run("bounce", push);
        const auto paths = bench().paths.download<scalar::PathData>(kCount);
        const auto rays = bench().rays.download<scalar::RayData>(kCount);
        const uint32_t count = bench().counters.download<scalar::CounterData>(1)[0].path_count;
        std::vector<uint8_t> goes_on(kCount, 0);
        for (uint32_t path : bench().next_path_list.download<uint32_t>(count)) goes_on.at(path) += 1;
        Flips flips;
        uint32_t kept = 0;
        for (uint32_t k = 0; k < kCount; ++k) {
            const auto expected = expect_bounce(bench(), cases_[k], vertices_[k], push);
            kept += expected ? 1 : 0;
            ASSERT_LE(goes_on[k], 1);
            if (!expected || goes_on[k] == 0) {
                if (expected.has_value() != (goes_on[k] == 1))
                    flips.add(cases_[k], describe_choice("bounce", k, goes_on[k] == 1));
            } else if (!(compare(paths[k].throughput, expected->throughput) < 1e-2f &&
                         is_like(rays[k], expected->ray))) {
                flips.add(cases_[k], describe(k, paths[k].throughput, expected->throughput) + ", " +
                                         describe(k, rays[k], expected->ray));
            }
        }
        EXPECT_LE(flips.count(), kAllowedFlips) << "depth " << depth << flips.text();
        EXPECT_GT(kept, kCount / 4) << "depth " << depth;
    }
}

TEST_F(ShadingKernels, add_the_light_of_shadow_rays_that_reach_it) {
    std::vector<ShadingCase> cases = cases_;
    std::vector<uint32_t> list;
    for (uint32_t k = 0; k < kCount; ++k) {
        cases[k].path.contribution = {float(k), 1, 2};
        cases[k].path.radiance = {1, 1, 1};
        if (k % 3 != 0) list.push_back(kCount + (kCount - 1 - k));
    }
    bench().upload(cases);
    std::vector<scalar::HitData> in_the_way(kCount);
    for (uint32_t k = 0; k < kCount; ++k) in_the_way[k].instance = k % 2 == 0 ? scalar::kNone : 0;
    bench().hits.upload(in_the_way, kCount * sizeof(scalar::HitData));
    bench().shadow_list.upload(list);
    scalar::PathPush push = bench().make_push(1);
    push.count = uint32_t(list.size());
    bench().run("shadow_light", push);
    const auto paths = bench().paths.download<scalar::PathData>(kCount);
    for (uint32_t k = 0; k < kCount; ++k) {
        const bool is_lit = k % 2 == 0 && (kCount - 1 - k) % 3 != 0;
        ASSERT_EQ(paths[k].radiance.x, is_lit ? 1 + float(k) : 1) << k;
    }
}

} // namespace
} // namespace relief::vulkan::tests
