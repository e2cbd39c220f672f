// The SIMD kernels of shading beside what they do many at once: the same numbers on every instruction set.
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cpu/shading/lights.h"
#include "cpu/shading/shading_kernels.h"
#include "formulas/basis.h"
#include "formulas/bsdf.h"
#include "formulas/glass_bsdf.h"
#include "formulas/layered_bsdf.h"
#include "formulas/lobe_shares.h"
#include "formulas/shading_normal.h"
#include "formulas/sobol.h"
#include "formulas/surface_point.h"
#include "formulas/warp.h"
#include "prepare/material_glass.h"
#include "prepare/material_layers.h"
#include "relief/render.h"
#include "support/hashed_texels.h"
#include "support/shading_scenes.h"

namespace relief {
namespace {

constexpr size_t kMany = 150; ///< several rounds of four times sixteen, the last one not full

/// Random numbers in [0, 1).
class Numbers {
  public:
    float next() { return pair().x; }
    Vec2f pair() {
        ++count_;
        return scalar::sobol_pair(17, count_ % 4096, count_ / 4096 + 2);
    }
    Vec3f direction() { return normalize(scalar::square_to_sphere(pair())); }

  private:
    uint32_t count_ = 0;
};

Environment make_sky_texture(uint32_t width, uint32_t height, uint32_t channels, bool has_halves) {
    Environment environment;
    environment.texture = test::make_hashed_texture(width, height, channels, has_halves);
    environment.color = {1, 0.5f, 0.25f};
    environment.rotate_degrees = 77;
    return environment;
}

template <class T> void expect_same_bits(const T& a, const T& b, size_t k, const std::string& isa) {
    ASSERT_EQ(std::memcmp(&a, &b, sizeof(T)), 0) << isa << ", number " << k;
}

void expect_kernels_of(const cpu::EnvironmentLight& light) {
    Numbers numbers;
    std::vector<Vec3f> directions{{0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}};
    std::vector<Vec2f> pairs{{0, 0}, {0.99999994f, 0.99999994f}};
    while (directions.size() < kMany) directions.push_back(numbers.direction());
    while (pairs.size() < kMany) pairs.push_back(numbers.pair());
    std::vector<cpu::EnvironmentLookup> found(kMany);
    std::vector<cpu::DirectionSample> drawn(kMany);
    std::vector<Vec3f> radiances(kMany);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Vec3f nowhere{nan, nan, nan};
    for (const std::string& isa : available_isas()) {
        // Anything, from within the image.
        light.look_up(cpu::find_shading_kernels(isa.c_str()), {&nowhere, 1}, found);
        for (const size_t count : {size_t(1), size_t(16), size_t(37), kMany}) {
            const cpu::ShadingKernels& kernels = cpu::find_shading_kernels(isa.c_str());
            light.look_up(kernels, {directions.data(), count}, found);
            light.draw_directions(kernels, {pairs.data(), count}, drawn);
            light.fetch_radiance(kernels, {pairs.data(), count}, radiances);
            for (size_t k = 0; k < count; ++k) {
                expect_same_bits(found[k], light.look_up(directions[k]), k, isa);
                expect_same_bits(drawn[k], light.draw_direction(pairs[k]), k, isa);
                expect_same_bits(radiances[k], light.radiance(pairs[k]), k, isa);
                if (testing::Test::HasFailure()) return;
            }
        }
    }
}

TEST(EnvironmentKernels, do_many_at_once_what_the_environment_does_one_by_one) {
    for (const bool has_halves : {false, true}) {
        for (const uint32_t width : {1u, 2u, 7u, 300u})
            expect_kernels_of(cpu::EnvironmentLight(make_sky_texture(width, 1 + width / 2, 3, has_halves)));
        expect_kernels_of(cpu::EnvironmentLight(make_sky_texture(64, 32, 1, has_halves)));
    }
    // Cells of several texels; a bright texel, dark rows and columns.
    Environment large = make_sky_texture(1500, 750, 3, false);
    Texture lights = *large.texture;
    for (size_t k = 0; k < lights.floats.size(); ++k)
        if (k / 6000 % 3 == 0 || k / 4 % 5 == 0) lights.floats[k] = 0;
    lights.floats[4 * (1500 * 200 + 1499)] = 1e6f;
    expect_kernels_of(cpu::EnvironmentLight(large));
    large.texture = std::make_shared<Texture>(lights);
    expect_kernels_of(cpu::EnvironmentLight(large));
    Environment plain;
    plain.color = {0.5f, 1, 2};
    expect_kernels_of(cpu::EnvironmentLight(plain));
}

struct KernelCase {
    cpu::SurfacePoint point;
    cpu::TraceRay ray;
    scalar::BsdfParameters material;
    uint32_t layers; ///< record of make_layers; kNoIndex: without
    uint32_t glass;  ///< record of make_glass, likewise
    Vec3f tangent, light;
    float light_pdf, light_lift;
    Vec2f pick, u;
};

constexpr uint32_t kLayeredCount = 9, kGlassCount = 4;

/// One material with all layers and one with some of each sort, the roughness of one textured; some of them
/// anisotropic.
MaterialLayers make_layers() {
    std::vector<Material> materials(kLayeredCount);
    materials[0].coat_weight = 0.7f, materials[0].coat_color = {0.9f, 0.5f, 0.2f};
    materials[0].fuzz_weight = 0.8f, materials[0].base_diffuse_roughness = 0.6f;
    materials[0].metallic = 0.3f, materials[0].specular_color = {1, 0.8f, 0.5f};
    materials[1].base_diffuse_roughness = 1, materials[1].ior = 1;
    materials[2].coat_weight = 1, materials[2].coat_roughness = 0.3f;
    materials[3].fuzz_weight = 1, materials[3].fuzz_roughness = 0.2f;
    materials[4].metallic = 1, materials[4].specular_weight = 0.8f;
    auto texture = std::make_shared<Texture>();
    texture->width = 2, texture->height = 1, texture->floats = {1, 1, 1, 1, 0, 0, 0, 1};
    materials[5].coat_weight = 0.4f;
    set_input_texture(materials[5], MaterialInput::roughness, texture); // rows of the albedo table
    materials[6].specular_roughness_anisotropy = 0.7f;
    materials[7] = materials[5], materials[7].specular_roughness_anisotropy = 0.4f;
    materials[7].coat_roughness = 0.5f, materials[7].coat_roughness_anisotropy = 0.8f;
    materials[8] = materials[0], materials[8].coat_roughness = 0.6f;
    materials[8].coat_roughness_anisotropy = 1;
    return make_material_layers(materials);
}

/// One of each kind.
MaterialGlass make_glass() {
    std::vector<Material> materials(kGlassCount);
    for (Material& m : materials) m.transmission_weight = 1, m.specular_color = {1, 0.7f, 0.4f};
    materials[0].transmission_color = {0.9f, 0.5f, 0.2f}, materials[0].ior = 1.3f;
    materials[1].is_thin_walled = materials[2].is_thin_walled = true;
    materials[1].transmission_color = {0.2f, 0.5f, 0.9f};
    materials[2].roughness = 0;
    materials[3].specular_roughness_anisotropy = 0.6f;
    return make_material_glass(materials);
}

/// Every kind of material in one batch, points seen from both sides and at grazing angles, lights behind the
/// surface and none at all.
std::vector<KernelCase> make_cases() {
    Numbers numbers;
    std::vector<KernelCase> cases(16 * 40);
    for (size_t k = 0; k < cases.size(); ++k) {
        KernelCase& c = cases[k];
        c.point.position = numbers.direction() * 10.0f;
        c.point.geometric_normal = numbers.direction();
        c.point.shading_normal = normalize(c.point.geometric_normal + numbers.direction() * numbers.next());
        c.point.position_error = 1e-5f * numbers.next();
        c.ray.direction = numbers.direction();
        if (k % 5 == 0)
            c.ray.direction = normalize(cross(c.point.geometric_normal, c.ray.direction) +
                                        c.point.geometric_normal * 1e-3f);
        const bool is_diffuse = k / 16 % 4 == 0 || k % 3 == 0;
        c.material = {{numbers.next(), numbers.next(), numbers.next()},
                      numbers.next(),
                      is_diffuse ? 0 : numbers.next(),
                      is_diffuse ? 1 : 1 + numbers.next()};
        // Batches without layers, with some, and of layers alone.
        const size_t batch = k / 16 % 5;
        c.layers = batch == 4 || (batch % 2 == 1 && k % 4 != 0) ? uint32_t(k % kLayeredCount) : kNoIndex;
        // The same with glass, in other batches.
        const size_t third = k / 16 % 3;
        c.glass = third == 2 || (third == 1 && k % 5 == 0) ? uint32_t(k % kGlassCount) : kNoIndex;
        if (c.glass != kNoIndex) c.layers = kNoIndex;
        c.light = numbers.direction(), c.tangent = numbers.direction();
        c.light_pdf = k % 7 == 0 ? 0 : numbers.next() + 0.1f;
        // From behind, as it comes to a coarse triangle of a smooth surface.
        const bool is_lifted =
            k % 4 == 1 && c.glass == kNoIndex &&
            dot(c.light, c.point.geometric_normal) * dot(c.ray.direction, c.point.geometric_normal) > 0;
        c.light_lift = is_lifted ? 1e-3f : 0.0f;
        c.pick = numbers.pair(), c.u = numbers.pair();
    }
    return cases;
}

using cpu::get_lane;

void set_lane(const KernelCase& c, size_t lane, cpu::VertexLanes& lanes) {
    for (int axis = 0; axis < 3; ++axis) {
        lanes.base_color[axis][lane] = get_component(c.material.base_color, axis);
        lanes.light_direction[axis][lane] = get_component(c.light, axis);
    }
    lanes.roughness[lane] = c.material.roughness, lanes.metallic[lane] = c.material.metallic;
    lanes.ior[lane] = c.material.ior, lanes.light_pdf[lane] = c.light_pdf;
    lanes.light_lift[lane] = c.light_lift;
    cpu::set_lane(c.tangent, lane, lanes.tangent);
    lanes.layers[lane] = c.layers, lanes.layered_metallic[lane] = c.material.metallic;
    if (lane == 0) lanes.has_layers = lanes.has_glass = 0;
    if (c.layers != kNoIndex) lanes.has_layers |= 1u << lane;
    lanes.glass[lane] = c.glass;
    if (c.glass != kNoIndex) lanes.has_glass |= 1u << lane;
}

cpu::LayerView view(const MaterialLayers& layers) {
    return {layers.records.data(), layers.entries.data(), uint32_t(layers.entries.size())};
}

struct CaseMaterials {
    MaterialLayers layers = make_layers();
    MaterialGlass glass = make_glass();
};

bool has_tangent(const KernelCase& c, const CaseMaterials& materials) {
    if (c.glass != kNoIndex) return materials.glass.records[c.glass].anisotropy > 0;
    return c.layers != kNoIndex && materials.layers.records[c.layers].azimuth_scale > 0;
}

/// The BSDF of a case, with or without layers, or of glass.
struct CaseBsdf {
    CaseBsdf(const KernelCase& c, const CaseMaterials& materials, const Vec3f& viewer, bool is_inside)
        : wo(viewer),
          has_layers(c.layers != kNoIndex),
          is_glass(c.glass != kNoIndex),
          table{materials.layers.entries.data()} {
        const MaterialLayers& layers = materials.layers;
        plain = scalar::make_bsdf(c.material, wo.z);
        if (is_glass)
            glass =
                scalar::make_glass_bsdf(materials.glass.records[c.glass], c.material.roughness, is_inside);
        if (!has_layers) return;
        scalar::LayeredSurface surface{c.material.base_color, c.material.roughness, layers.records[c.layers]};
        surface.layers.metallic = c.material.metallic;
        layered = scalar::make_layered_bsdf(surface, table, wo);
    }
    scalar::BsdfValue evaluate(const Vec3f& wi) const {
        return is_glass     ? scalar::evaluate_glass_bsdf(glass, wo, wi)
               : has_layers ? scalar::evaluate_layered_bsdf(layered, table, wo, wi)
                            : scalar::evaluate_bsdf(plain, wo, wi);
    }
    Vec3f evaluate_diffuse(const Vec3f& wi) const {
        return is_glass     ? Vec3f{}
               : has_layers ? scalar::evaluate_layered_diffuse(layered, table, wo, wi)
                            : scalar::evaluate_diffuse(plain, wo, wi);
    }
    scalar::BsdfSample sample(float lobe, const Vec2f& u) const {
        return is_glass     ? scalar::sample_glass_bsdf(glass, wo, lobe, u)
               : has_layers ? scalar::sample_layered_bsdf(layered, table, wo, lobe, u)
                            : scalar::sample_bsdf(plain, wo, lobe, u);
    }

    /// Whether a direction is above, or of glass on one side of both normals.
    bool is_possible(const Vec3f& local, float height) const {
        return is_glass && local.z < 0 ? height < 0 : height > 0 && (local.z > 0 || !is_glass);
    }

    Vec3f wo;
    bool has_layers, is_glass;
    scalar::LayerTable table;
    scalar::Bsdf plain;
    scalar::LayeredBsdf layered{};
    scalar::GlassBsdf glass{};
};

/// The same with the formulas for one.
void expect_lane(const KernelCase& c, const CaseMaterials& materials, const cpu::VertexLanes& lanes,
                 size_t lane) {
    const Vec3f wo = -c.ray.direction;
    const bool is_behind = dot(c.point.geometric_normal, wo) < 0;
    const Vec3f geometric = is_behind ? -c.point.geometric_normal : c.point.geometric_normal;
    const Vec3f shading = is_behind ? -c.point.shading_normal : c.point.shading_normal;
    EXPECT_EQ(get_lane(lanes.geometric_normal, lane), geometric);
    EXPECT_EQ(get_lane(lanes.shading_normal, lane), shading);
    const Vec3f normal = scalar::bend_normal(shading, geometric, wo);
    const scalar::Basis basis =
        has_tangent(c, materials) ? scalar::make_basis_along(normal, c.tangent) : scalar::make_basis(normal);
    const Vec3f wo_local = scalar::lift_viewer(scalar::to_local(basis, wo));
    const CaseBsdf bsdf(c, materials, wo_local, is_behind);

    const Vec3f light_local = scalar::to_local(basis, c.light);
    const scalar::BsdfValue value = bsdf.evaluate(light_local);
    const bool is_lifted = c.light_lift > 0;
    const bool needs_shadow_ray = c.light_pdf > 0 &&
                                  (is_lifted || bsdf.is_possible(light_local, dot(c.light, geometric))) &&
                                  !(value.value == Vec3f{});
    ASSERT_EQ(lanes.needs_shadow_ray >> lane & 1, needs_shadow_ray);
    EXPECT_EQ(get_lane(lanes.light_reflected, lane), value.value);
    EXPECT_EQ(lanes.light_bsdf_pdf[lane], is_lifted ? 0 : value.pdf);
    const Vec3f to_light = scalar::to_local(basis, c.light);
    EXPECT_EQ(get_lane(lanes.light_diffuse, lane),
              scalar::find_shares(bsdf.evaluate_diffuse(to_light), value.value));
    const auto offset = [&](const Vec3f& direction) {
        return scalar::offset_origin(c.point.position, geometric, c.point.position_error, direction);
    };
    EXPECT_EQ(get_lane(lanes.shadow_origin, lane),
              is_lifted ? c.point.position + geometric * (c.point.position_error + c.light_lift)
                        : offset(c.light));

    const scalar::BsdfSample drawn = bsdf.sample(c.pick.y, c.u);
    const Vec3f direction = normalize(scalar::from_local(basis, drawn.direction));
    const bool has_bounce =
        !(drawn.weight == Vec3f{}) && bsdf.is_possible(drawn.direction, dot(geometric, direction));
    ASSERT_EQ(lanes.has_bounce >> lane & 1, has_bounce);
    if (!has_bounce) return;
    EXPECT_EQ(get_lane(lanes.bounce_direction, lane), direction);
    EXPECT_EQ(get_lane(lanes.bounce_weight, lane), drawn.weight);
    EXPECT_EQ(lanes.bounce_pdf[lane], drawn.pdf);
    EXPECT_EQ(get_lane(lanes.bounce_origin, lane), offset(direction));
    EXPECT_EQ(get_lane(lanes.bounce_diffuse, lane),
              scalar::find_shares(bsdf.evaluate_diffuse(scalar::to_local(basis, direction)),
                                  drawn.weight * drawn.pdf));
}

TEST(ReflectionKernels, reflect_at_sixteen_vertices_what_the_formulas_say_for_one) {
    const std::vector<KernelCase> cases = make_cases();
    const CaseMaterials materials;
    for (const std::string& isa : available_isas()) {
        uint32_t lit = 0, going = 0;
        for (size_t first = 0; first < cases.size(); first += 16) {
            const size_t count = first % 3 == 0 ? 16 : 1 + first / 16 % 15;
            std::array<cpu::SurfacePoint, 16> points;
            std::array<cpu::TraceRay, 16> rays;
            std::array<Vec2f, 16> picks, pairs;
            cpu::VertexLanes lanes;
            std::memset(&lanes, 0xff, sizeof lanes); // NaN in the lanes beyond
            for (size_t lane = 0; lane < count; ++lane) {
                const KernelCase& c = cases[first + lane];
                points[lane] = c.point, rays[lane] = c.ray, picks[lane] = c.pick, pairs[lane] = c.u;
                set_lane(c, lane, lanes);
            }
            cpu::find_shading_kernels(isa.c_str())
                .reflect({count, points.data(), rays.data(), picks.data(), pairs.data(),
                          view(materials.layers), materials.glass.records.data(), true},
                         lanes);
            EXPECT_EQ((lanes.needs_shadow_ray | lanes.has_bounce) >> count, 0);
            for (size_t lane = 0; lane < count; ++lane) {
                expect_lane(cases[first + lane], materials, lanes, lane);
                ASSERT_FALSE(testing::Test::HasFailure()) << isa << ", case " << first + lane;
            }
            lit += uint32_t(std::popcount(lanes.needs_shadow_ray)),
                going += uint32_t(std::popcount(lanes.has_bounce));
        }
        EXPECT_GT(lit, 100);
        EXPECT_GT(going, 250);
    }
}

TEST(ReflectionKernels, let_no_path_go_on_without_random_numbers) {
    const KernelCase c = make_cases()[1];
    for (const std::string& isa : available_isas()) {
        cpu::VertexLanes lanes{};
        set_lane(c, 0, lanes);
        lanes.has_bounce = 1;
        cpu::find_shading_kernels(isa.c_str()).reflect({1, &c.point, &c.ray, nullptr, nullptr, {}}, lanes);
        EXPECT_EQ(lanes.has_bounce, 0) << isa;
    }
}

/// An environment, a sun, a small and a large point light, a glowing quad.
Scene make_lit_scene() {
    Scene scene;
    add_object(scene, make_floor(10), make_matte(0.5f));
    Material glowing = make_matte(0);
    glowing.emission = {300, 300, 300};
    add_object(scene, make_floor(1), glowing);
    scene.objects.back().world_from_object.translation = {2, 1, 0};
    scene.environment = make_sky_texture(64, 32, 3, false);
    scene.lights.resize(3);
    scene.lights[0].strength = 400;
    for (int k = 1; k < 3; ++k) {
        scene.lights[k].type = LightType::point, scene.lights[k].strength = 500;
        scene.lights[k].position = {-1, 1.5f, 0}, scene.lights[k].radius = k == 1 ? 0.0f : 0.3f;
    }
    return scene;
}

TEST(Lights, are_drawn_for_many_points_as_for_each) {
    RenderSettings settings;
    const cpu::Tracer tracer(prepare_scene(make_lit_scene(), settings), settings);
    const cpu::LightSet lights(tracer);
    Numbers numbers;
    std::vector<cpu::LightSet::Receiver> at(kMany);
    std::vector<cpu::LightSet::RandomNumbers> random(kMany);
    for (size_t k = 0; k < kMany; ++k) {
        at[k] = {numbers.direction(), 0, {0, 1, 0}, 0};
        random[k] = {numbers.next(), numbers.next(), numbers.pair()};
    }
    std::vector<cpu::LightSample> drawn(kMany);
    lights.draw(at, random, drawn);
    std::vector<uint32_t> odd;
    for (uint32_t k = 1; k < kMany; k += 2) odd.push_back(k);
    lights.complete_weight(drawn, odd);
    std::array<size_t, 4> counts{}; // environment, sun, lights, quad
    for (uint32_t k = 0; k < kMany; ++k) {
        cpu::LightSample one;
        const uint32_t first = 0;
        lights.draw({&at[k], 1}, {&random[k], 1}, {&one, 1});
        const bool is_environment = one.lacks_radiance;
        counts[is_environment ? 0 : one.emitter ? 3 : std::isinf(one.distance) ? 1 : 2] += 1;
        if (k % 2 == 1) lights.complete_weight({&one, 1}, {&first, 1});
        EXPECT_EQ(drawn[k].lacks_radiance, is_environment && k % 2 == 0) << k;
        EXPECT_EQ(drawn[k].direction, one.direction) << k;
        EXPECT_EQ(drawn[k].distance, one.distance) << k;
        EXPECT_EQ(drawn[k].weight, one.weight) << k;
        EXPECT_EQ(drawn[k].pdf, one.pdf) << k;
        EXPECT_EQ(drawn[k].emitter.has_value(), one.emitter.has_value()) << k;
    }
    for (const size_t count : counts) EXPECT_GT(count, 3u);
}

TEST(Lights, are_drawn_from_each_of_several_suns) {
    Scene scene;
    add_object(scene, make_floor(10), make_matte(0.5f));
    scene.lights.resize(3);
    for (size_t k = 0; k < 3; ++k) {
        scene.lights[k].direction = normalize(Vec3f{float(k) - 1, -1, 0.5f});
        scene.lights[k].strength = float(k + 1),
        scene.lights[k].angle_degrees = 4 * float(k); // the first is hard
    }
    RenderSettings settings;
    const cpu::Tracer tracer(prepare_scene(scene, settings), settings);
    const cpu::LightSet lights(tracer);
    const LightTables tables = make_light_tables(tracer.scene(), 0, {});
    ASSERT_EQ(tables.sources.size(), 3u);
    Numbers numbers;
    std::vector<cpu::LightSet::Receiver> at(kMany, {{0, 0, 0}, 0, {0, 1, 0}, 0});
    std::vector<cpu::LightSet::RandomNumbers> random(kMany);
    for (auto& some : random) some = {numbers.next(), numbers.next(), numbers.pair()};
    std::vector<cpu::LightSample> drawn(kMany);
    lights.draw(at, random, drawn);
    float power = 0;
    for (const scalar::LightSourceData& source : tables.sources) power += source.power;
    std::array<size_t, 3> counts{};
    for (size_t k = 0; k < kMany; ++k) {
        size_t picked = 0;
        for (float below = tables.sources[0].power; below <= random[k].u_light * power && picked < 2;)
            below += tables.sources[++picked].power;
        const scalar::LightSourceData& sun = tables.sources[picked];
        ++counts[picked];
        const scalar::LightDraw one = scalar::draw_listed_light(sun, {}, random[k].u);
        const float probability = sun.power / power;
        EXPECT_EQ(drawn[k].direction, one.direction) << k;
        EXPECT_EQ(drawn[k].distance, one.distance) << k;
        EXPECT_EQ(drawn[k].weight, one.weight * (1 / probability)) << k;
        EXPECT_EQ(drawn[k].pdf, one.pdf * probability) << k;
        EXPECT_EQ(drawn[k].group, sun.group) << k;
    }
    for (const size_t count : counts) EXPECT_GT(count, 10u);
}

} // namespace
} // namespace relief
