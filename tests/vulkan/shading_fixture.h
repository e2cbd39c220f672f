// The kernels of the path tracer one by one: tables of a small scene with every kind of surface and light,
// paths and hits made up by the test, and the CPU engine's view of the same.
#pragma once

#include <algorithm>
#include <numeric>
#include <optional>
#include <string_view>
#include <vector>

#include "cpu/shading/lights.h"
#include "cpu/shading/normal_maps.h"
#include "cpu/shading/textures.h"
#include "cpu/tracer.h"
#include "formulas/basis.h"
#include "formulas/bsdf.h"
#include "formulas/cell_place.h"
#include "formulas/constants.h"
#include "formulas/layered_bsdf.h"
#include "formulas/path.h"
#include "formulas/shading_normal.h"
#include "formulas/sobol.h"
#include "formulas/warp.h"
#include "gpu_fixture.h"
#include "support/bodies.h"
#include "support/shading_scenes.h"
#include "vulkan/device/commands.h"
#include "vulkan/device_lights.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/layout/device_paths.h"
#include "vulkan/layout/device_rays.h"

namespace relief::vulkan::tests {

inline std::shared_ptr<Texture> make_colors(uint32_t width, uint32_t height, float brightest, uint32_t seed) {
    auto texture = std::make_shared<Texture>();
    texture->width = width, texture->height = height, texture->channel_count = 3;
    for (uint32_t k = 0; k < width * height; ++k)
        for (uint32_t c = 0; c < 4; ++c)
            texture->floats.push_back(
                c == 3 ? 1.0f : brightest * scalar::uint_to_unit(scalar::hash_combine(seed, 4 * k + c)));
    return texture;
}

inline std::shared_ptr<Texture> make_half_greys(uint32_t width, uint32_t height) {
    auto texture = std::make_shared<Texture>();
    texture->width = width, texture->height = height, texture->channel_count = 1;
    for (uint32_t k = 0; k < width * height; ++k)
        // 0x3800 to 0x3bff: from a half to one.
        texture->halves.insert(texture->halves.end(),
                               {uint16_t(0x3800 + scalar::hash_uint(k) % 0x400), 0, 0, 0x3c00});
    return texture;
}

inline void add_lights(Scene& scene) {
    Light sun, delta_sun, point, delta_point;
    sun.direction = {1, -2, 0.5f}, sun.angle_degrees = 12, sun.strength = 2;
    delta_sun.direction = {-1, -1, 0}, delta_sun.angle_degrees = 0, delta_sun.color = {1, 0.5f, 0.25f};
    point.type = delta_point.type = LightType::point;
    point.position = {2, 3, 1}, point.radius = 0.6f, point.strength = 20;
    delta_point.position = {-3, 2, 2}, delta_point.strength = 15;
    scene.lights = {sun, delta_sun, point, delta_point};
    Environment environment;
    environment.texture = make_colors(48, 24, 2, 5);
    environment.rotate_degrees = 77;
    environment.strength = 0.7f;
    scene.environment = environment;
}

inline void add_displaced(Scene& scene, Mesh mesh, DisplacementSpace space, const Affine& place,
                          const Material& material) {
    add_object(scene, std::move(mesh), material);
    scene.objects.back().displacement = uint32_t(scene.displacements.size());
    scene.objects.back().world_from_object = place;
    scene.displacements.push_back(
        test::make_displacement(test::make_random_map(64, 48, 0.1f, 3 + uint32_t(space)), space));
}

/// Tangent and object space, a mirrored emitter, plain quads and smooth normals; textures repeat.
inline Scene make_shading_scene() {
    Scene scene;
    Material colored = make_matte(0.9f), shiny, glowing;
    const auto greys = make_half_greys(8, 5);
    set_input_texture(colored, MaterialInput::base_color, make_colors(17, 9, 1.2f, 1), MapFilter::cubic);
    set_input_texture(shiny, MaterialInput::roughness, greys, MapFilter::bspline);
    shiny.metallic = 0.4f, shiny.roughness = 0.6f;
    set_input_texture(shiny, MaterialInput::metallic, make_half_greys(5, 8));
    set_input_texture(colored, MaterialInput::metallic, greys);
    colored.metallic = 0.5f;
    shiny.coat_weight = 0.7f, shiny.coat_color = {0.9f, 0.5f, 0.2f}, shiny.coat_roughness = 0.2f;
    shiny.fuzz_weight = 0.6f, shiny.base_diffuse_roughness = 0.5f, shiny.specular_color = {1, 0.8f, 0.6f};
    glowing.emission = {4, 3, 1};
    const auto normals = make_colors(23, 11, 1, 9);
    set_input_texture(colored, MaterialInput::normal, normals), colored.normal_scale = 0.6f;
    set_input_texture(shiny, MaterialInput::normal, normals, MapFilter::cubic), shiny.normal_flip_y = true;
    add_displaced(scene, test::make_cube_sphere(3), DisplacementSpace::tangent, Affine{}, colored);
    scene.displacements.back().filter = MapFilter::mip, scene.displacements.back().autobump = true;
    Mesh torus = test::make_torus(6, 8);
    torus.subdivision.scheme = SubdivisionScheme::catmark;
    torus.subdivision.level = 0;
    add_displaced(scene, torus, DisplacementSpace::object,
                  compose(make_translation({2.5f, 0.5f, 0}), make_scale({-0.5f, 0.6f, 0.7f})), glowing);
    set_input_texture(scene.materials.back(), MaterialInput::normal, normals);
    Mesh floor = make_floor(6);
    floor.uvs = {{-1.7f, 3.2f}, {2.9f, 3.1f}, {3.0f, -2.5f}, {-1.6f, -2.4f}};
    add_object(scene, floor, shiny);
    scene.objects.back().world_from_object = make_translation({0, -2, 0});
    add_object(scene, make_sphere(3, SphereNormals::smooth), glowing);
    scene.objects.back().world_from_object =
        compose(make_translation({-2.5f, 0, 1}), make_scale({0.3f, 0.4f, 0.3f}));
    add_lights(scene);
    scene.camera.from = {0, 2, 9}, scene.camera.focus_distance = 8, scene.camera.aperture_radius = 0.1f;
    return scene;
}

/// A path that met something, as both engines see it.
struct ShadingCase {
    cpu::TraceHit hit;
    scalar::RayData ray;
    scalar::PathData path;
};

class ShadingBench {
  public:
    static constexpr uint32_t kCount = 4096;

    ShadingBench(const Device& device, std::shared_ptr<const PreparedScene> scene,
                 const RenderSettings& settings)
        : prepared(std::move(scene)),
          tracer(prepared, settings),
          cpu_lights(tracer),
          device_scene(device, *prepared),
          lights(device, *prepared, device_scene),
          bindings(device),
          commands(device, bindings),
          device_(device) {
        device_scene.bind(bindings);
        lights.bind(bindings);
        rays = make<scalar::RayData>(scalar::kBindRays, 2 * kCount);
        hits = make<scalar::HitData>(scalar::kBindHits, 2 * kCount);
        counters = make<scalar::CounterData>(scalar::kBindCounters, 1);
        paths = make<scalar::PathData>(scalar::kBindPaths, kCount);
        points = make<scalar::SurfacePointData>(scalar::kBindPoints, kCount);
        film = make<scalar::FilmSumsData>(scalar::kBindFilm, kCount);
        path_list = make<uint32_t>(scalar::kBindPathList, kCount);
        next_path_list = make<uint32_t>(scalar::kBindNextPathList, kCount);
        shadow_list = make<uint32_t>(scalar::kBindShadowList, kCount);
        std::vector<uint32_t> all(kCount);
        std::iota(all.begin(), all.end(), 0u);
        path_list.upload(all);
    }

    scalar::PathPush make_push(uint32_t depth) const {
        scalar::PathPush push{};
        lights.describe(push);
        push.count = push.capacity = kCount;
        push.depth = depth;
        push.last_depth = 6;
        push.sample_index = 5;
        return push;
    }

    void upload(const std::vector<ShadingCase>& cases) {
        std::vector<scalar::HitData> hit_data;
        std::vector<scalar::RayData> ray_data;
        std::vector<scalar::PathData> path_data;
        for (const ShadingCase& c : cases) {
            hit_data.push_back({c.hit.t, c.hit.instance, c.hit.patch, c.hit.u, c.hit.v,
                                scalar::make_cell_rank(c.hit.i, c.hit.j, c.hit.is_upper), c.hit.levels});
            ray_data.push_back(c.ray);
            path_data.push_back(c.path);
        }
        hits.upload(hit_data);
        rays.upload(ray_data);
        paths.upload(path_data);
    }

    template <class Push> void run(const char* shader, const Push& push) {
        const bool is_normal = std::string_view(shader) == "shading_normal";
        const Kernel kernel(device_, {.shader = shader,
                                      .constants = is_normal ? device_scene.add_normal_maps({64})
                                                             : device_scene.add_layers({64})});
        commands.dispatch(kernel, push.count, push);
        commands.run();
    }

    std::shared_ptr<const PreparedScene> prepared;
    cpu::Tracer tracer;
    cpu::LightSet cpu_lights;
    DeviceScene device_scene;
    DeviceLights lights;
    BindingTable bindings;
    vulkan::Commands commands;
    Buffer rays, hits, counters, paths, points, film, path_list, next_path_list, shadow_list;

  private:
    /// Zeros, bound.
    template <class T> Buffer make(uint32_t binding, uint64_t count) {
        Buffer buffer(device_, {.name = "test", .bytes = count * sizeof(T)});
        commands.fill(buffer, 0, count * sizeof(T), 0);
        commands.run();
        bindings.bind(binding, buffer);
        return buffer;
    }
    const Device& device_;
};

/// Random numbers of one case.
class CaseRandom {
  public:
    explicit CaseRandom(uint32_t index) : seed_(scalar::hash_uint(index)) {}
    float next() { return scalar::uint_to_unit(scalar::hash_combine(seed_, ++count_)); }
    Vec3f next_direction() {
        const float x = next(), y = next();
        return normalize(scalar::square_to_sphere({x, y}));
    }

  private:
    uint32_t seed_, count_ = 0;
};

/// Hits all over the scene, seen from everywhere.
inline std::vector<ShadingCase> make_cases(const PreparedScene& scene) {
    std::vector<ShadingCase> cases(ShadingBench::kCount);
    for (uint32_t k = 0; k < cases.size(); ++k) {
        CaseRandom random(k);
        ShadingCase& c = cases[k];
        c.hit.instance = k % uint32_t(scene.instances.size());
        const Instance& instance = scene.instances[c.hit.instance];
        const Surface& surface = scene.surfaces[instance.surface];
        c.hit.patch = uint32_t(random.next() * float(surface.patch_count()));
        c.hit.lod_bias = uint8_t(random.next() * 3);
        const PatchLevels levels = instance.levels->at(c.hit.patch).biased(c.hit.lod_bias);
        c.hit.levels = pack_levels(levels);
        const float u = random.next(), v = random.next();
        const scalar::CellPlace place =
            scalar::locate_cell(surface.quads[c.hit.patch].is_triangle(), 1u << levels.patch, u, v);
        c.hit.u = place.u, c.hit.v = place.v;
        c.hit.i = uint16_t(place.i), c.hit.j = uint16_t(place.j), c.hit.is_upper = place.is_upper;
        c.hit.t = 1 + random.next();
        c.ray = {{}, 0, random.next_direction(), scalar::make_infinity(), c.hit.lod_bias};
        c.path.throughput = {0.2f + 0.8f * random.next(), 0.5f, 1};
        c.path.bsdf_pdf = 0.1f + random.next();
        c.path.previous = random.next_direction() * 5.0f;
        c.path.pixel_seed = scalar::hash_uint(k + 77);
        c.path.cost = 1;
        c.path.body = scalar::kNone;
    }
    return cases;
}

/// What the CPU engine shades at a hit.
struct CpuVertex {
    cpu::SurfacePoint point; ///< normals on the viewer's side
    bool is_flipped;
    Material material;
    scalar::Basis basis;
    Vec3f wo_local;
    scalar::Bsdf bsdf;
    std::optional<scalar::LayeredBsdf> layered;
    scalar::LayerTable table;

    scalar::BsdfValue evaluate(const Vec3f& wi) const {
        return layered ? scalar::evaluate_layered_bsdf(*layered, table, wo_local, wi)
                       : scalar::evaluate_bsdf(bsdf, wo_local, wi);
    }
    scalar::BsdfSample sample(float lobe, const Vec2f& u) const {
        return layered ? scalar::sample_layered_bsdf(*layered, table, wo_local, lobe, u)
                       : scalar::sample_bsdf(bsdf, wo_local, lobe, u);
    }
};

inline CpuVertex make_vertex(const cpu::Tracer& tracer, const ShadingCase& c) {
    const PreparedScene& scene = tracer.scene();
    CpuVertex v;
    v.point = tracer.make_surface_point(c.hit);
    cpu::map_shading_normals(scene, {&c.hit, 1}, {&v.point, 1});
    v.material = scene.materials[scene.instances[c.hit.instance].material];
    Material& m = v.material;
    const auto fetch = [&](MaterialInput input) {
        const InputTexture* texture = find_input_texture(m, input);
        return texture ? cpu::fetch_texture(*texture->tiles[0].texture, texture->filter, v.point.uv)
                       : Vec3f{1, 1, 1};
    };
    m.base_color = m.base_color * fetch(MaterialInput::base_color);
    m.roughness *= fetch(MaterialInput::roughness).x;
    m.metallic *= fetch(MaterialInput::metallic).x;
    m.base_color = scalar::limit_color(m.base_color);
    m.metallic = std::clamp(m.metallic, 0.0f, 1.0f);
    const Vec3f wo = -c.ray.direction;
    v.is_flipped = dot(v.point.geometric_normal, wo) < 0;
    if (v.is_flipped)
        v.point.geometric_normal = -v.point.geometric_normal,
        v.point.shading_normal = -v.point.shading_normal;
    v.basis = scalar::make_basis(scalar::bend_normal(v.point.shading_normal, v.point.geometric_normal, wo));
    v.wo_local = scalar::lift_viewer(scalar::to_local(v.basis, wo));
    v.bsdf = scalar::make_bsdf({m.base_color, m.roughness, m.metallic, m.ior}, v.wo_local.z);
    v.table = {scene.layers.entries.data()};
    const uint32_t record = scene.layers.record_of_material.at(scene.instances[c.hit.instance].material);
    if (record == kNoIndex) return v;
    scalar::LayeredSurface surface{m.base_color, m.roughness, scene.layers.records[record]};
    surface.layers.metallic = m.metallic;
    v.layered = scalar::make_layered_bsdf(surface, v.table, v.wo_local);
    return v;
}

} // namespace relief::vulkan::tests
