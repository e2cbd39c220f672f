// Light at a vertex: emission of the surface, and next-event estimation, whose shadow ray is traced later.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/paths.glsl"
#include "vulkan/shaders/environment_light.glsl"
#include "vulkan/shaders/light_tree.glsl"
#include "vulkan/shaders/lights.glsl"
#include "vulkan/shaders/surface_point.glsl"
#include "vulkan/shaders/light_sums.glsl"
#include "vulkan/shaders/terminator.glsl"
#include "vulkan/shaders/material_inputs.glsl"
#include "formulas/guides.h"

layout(scalar, push_constant) uniform Push { PathPush push; };

/// A light sampled for one vertex.
struct DrawnLight {
    LightDraw light;
    bool is_surface;
    vec3 end; ///< of the shadow ray, just short of an emissive surface
    uint group;
};

/// `is_open`: light from behind the surface counts.
DrawnLight draw_from_environment(vec3 normal, bool is_open, vec2 u) {
    EnvironmentDraw drawn = draw_environment_direction(push.environment, u);
    DrawnLight result = {{drawn.direction, make_infinity(), vec3(0.0), 0.0}, false, vec3(0.0), kNone};
    // Early out without reading the image: half of the directions point into the surface.
    if (!(drawn.pdf > 0.0) || (!is_open && dot(drawn.direction, normal) <= 0.0)) return result;
    result.light.weight = environment_radiance_at(push.environment, drawn.position) * (1.0 / drawn.pdf);
    result.light.pdf = drawn.pdf;
    return result;
}

/// A tree has chosen the emissive patch itself.
float load_probability(uint emitter) { return kHasLightTree != 0u ? 1.0 : load_emitter_probability(emitter); }

DrawnLight draw_from_emitter(vec3 position, uint lod_bias, uint emitter, vec2 u) {
    uvec2 range = find_emitter_range(push.emitter_count, push.emitter_range_count, 0u, emitter);
    InstanceData instance = instances[range.y];
    uint patch_index = emitter - range.x;
    bool is_polygon = is_triangle(load_quad(surfaces[instance.surface], patch_index));
    CellPoint point = evaluate_point(instance, patch_index, is_polygon ? square_to_triangle(u) : u, lod_bias);
    vec3 to = point.triangle.position - position;
    float pdf =
        emitter_density(load_probability(emitter), point.triangle.area_per_uv, point.triangle.normal, to);
    MaterialData material = materials[instance.material];
    if (has_input_textures(material)) {
        vec2 at = is_polygon ? square_to_triangle(u) : u;
        InputNumbers numbers = find_inputs_at(material_inputs[material.inputs], instance, patch_index, at);
        material.emission = get_input_color(numbers, kInputEmission);
    }
    DrawnLight result = {draw_emitter(material.emission, to, pdf), true, vec3(0.0), kNone};
    result.end =
        offset_origin(point.triangle.position, point.triangle.normal, point.position_error, -result.light.direction);
    result.group = material.light_group;
    return result;
}

DrawnLight draw_from(LightPick pick, SurfacePointData at, bool is_open, uint lod_bias, float u_emitter, vec2 u) {
    if (kHasLightTree != 0u && pick.source == kNone) return draw_from_emitter(at.position, lod_bias, pick.emitter, u);
    LightSourceData source = sources[pick.source];
    if (source.kind == kSourceEnvironment) return draw_from_environment(at.geometric_normal, is_open, u);
    if (source.kind == kSourceEmitters)
        return draw_from_emitter(at.position, lod_bias, find_emitter(push.emitter_count, u_emitter), u);
    DrawnLight result = {draw_listed_light(source, at.position, u), false, vec3(0.0), kNone};
    if (has_texture(source) && result.light.pdf > 0.0)
        result.light.weight *= find_light_color(source, at.position, result.light.direction);
    return result;
}

/// Selects a light in proportion to its estimated irradiance, then a direction; density 0: no sample.
DrawnLight draw_light(SurfacePointData at, uint instance, bool is_open, uint lod_bias, vec2 pick_and_emitter, vec2 u) {
    LitPoint lit = {at.position, at.geometric_normal, instance};
    LightPick pick =
        pick_light(push.source_count, push.first_light_node, lit, pick_and_emitter.x, pick_and_emitter.y);
    DrawnLight drawn = {{vec3(0.0), 0.0, vec3(0.0), 0.0}, false, vec3(0.0), kNone};
    if (pick.source == kNone && pick.emitter == kNone) return drawn;
    drawn = draw_from(pick, at, is_open, lod_bias, pick_and_emitter.y, u);
    if (!drawn.is_surface) drawn.group = sources[pick.source].group;
    if (!is_open && dot(drawn.light.direction, at.geometric_normal) <= 0.0) drawn.light.pdf = 0.0;
    drawn.light.pdf *= pick.probability;
    drawn.light.weight *= 1.0 / pick.probability;
    return drawn;
}

/// Probability of an emissive patch; without a tree of all of them.
float find_emitter_probability(LitPoint at, uint emitter) {
    if (kHasLightTree != 0u) {
        uint leaf = texelFetch(emitter_table, int(emitter)).y;
        if (leaf == kNone) return 0.0;
        float listed = total_irradiance(push.source_count, at);
        float list_share = 1.0 - find_share_of_tree(push.first_light_node, at, listed);
        return (1.0 - list_share) * find_in_tree(push.first_light_node, at, leaf);
    }
    if (push.source_count == 0u || sources[push.source_count - 1u].kind != kSourceEmitters) return 0.0;
    return estimate_irradiance(sources[push.source_count - 1u], at.position) /
           total_irradiance(push.source_count, at);
}

/// Density with which draw_light at the previous vertex would have sampled this point.
float emitter_pdf(PathData path, HitData hit, SurfacePointData point) {
    if (push.emitter_range_count == 0u) return 0.0;
    uint emitter =
        find_emitter_range(push.emitter_count, push.emitter_range_count, 1u, hit.instance).x + hit.patch_index;
    LitPoint previous = {path.previous, path.normal, path.instance};
    return find_emitter_probability(previous, emitter) *
           emitter_density(load_probability(emitter), point.area_per_uv, point.geometric_normal,
                           point.position - path.previous);
}

vec3 find_emission(PathData path, HitData hit, SurfacePointData point, vec3 emission) {
    if (emission == vec3(0.0)) return vec3(0.0);
    if (push.depth == 0u) return path.throughput * emission;
    vec3 light = path.throughput * emission * power_heuristic(path.bsdf_pdf, emitter_pdf(path, hit, point));
    return clamp_indirect(light, push.clamp_indirect, push.depth - 1u);
}

/// `lift`: how far the ray starts above the triangle, where the light comes from below it.
RayData make_shadow_ray(SurfacePointData point, DrawnLight drawn, float lift, uint lod_bias) {
    vec3 origin =
        lift > 0.0
            ? point.position + point.geometric_normal * (point.position_error + lift)
            : offset_origin(point.position, point.geometric_normal, point.position_error, drawn.light.direction);
    RayData ray = {origin, 0.0, drawn.light.direction, drawn.light.distance, lod_bias};
    if (drawn.is_surface) {
        vec3 to = drawn.end - origin;
        ray.t_max = length(to) * (1.0 - 1e-6);
        ray.direction = make_unit(to);
    }
    return ray;
}

/// Shadow catchers are white and diffuse, so that nothing but light and its cosine counts.
VertexMaterial load_material(uint path_index, HitData hit) {
    uint index = instances[hit.instance].material;
    if (!is_catcher(hit, push.depth)) return load_vertex_material(index, push.capacity, path_index);
    VertexMaterial white;
    white.numbers = load_material_numbers(index);
    white.numbers.emission = vec3(0.0);
    white.numbers.ior = 1.0;
    white.numbers.has_layers = white.numbers.has_glass = 0u;
    white.table = make_layer_table(kGridTable);
    white.tangent = vec3(0.0);
    return white;
}

/// Sets the shadow ray and its contribution; false if zero. MIS weight 1 without bounces and on shadow catchers: no
/// other ray finds lights.
bool sample_light(uint path_index, PathData path, SurfacePointData point, HitData hit) {
    uint material_index = instances[hit.instance].material;
    VertexMaterial material = load_material(path_index, hit);
    RayData ray = rays[path_index];
    vec2 pick = draw_bounce_pair(path.pixel_seed, push.sample_index, push.depth, kPickPair);
    vec2 u = draw_bounce_pair(path.pixel_seed, push.sample_index, push.depth, kLightPair);
    vec2 last = draw_bounce_pair(path.pixel_seed, push.sample_index, push.depth, kRoulettePair);
    bool is_open = is_see_through(material.numbers) || may_lift(hit);
    DrawnLight drawn = draw_light(point, hit.instance, is_open, ray.lod_bias, vec2(pick.x, last.y), u);
    if (!(drawn.light.pdf > 0.0)) return false;
    Scattering scattering = make_scattering(point, material, -ray.direction, pick.y);
    vec3 wi = to_local(scattering.basis, drawn.light.direction);
    float lift = scattering.is_glass ? 0.0 : find_light_lift(hit, point, drawn.light.direction);
    bool is_lifted = lift > 0.0;
    if (is_open && !is_lifted && !is_on_one_side(scattering, point, drawn.light.direction, wi)) return false;
    BsdfValue bsdf = evaluate_scattering(scattering, wi);
    // No other ray finds light from below the triangle.
    bool is_caught = is_catcher(hit, push.depth);
    bool is_alone = push.last_depth == 0u || is_lifted || is_caught;
    float weight = is_alone ? 1.0 : power_heuristic(drawn.light.pdf, bsdf.pdf);
    vec3 contribution = path.throughput * bsdf.value * drawn.light.weight * weight;
    if (contribution == vec3(0.0) || !is_finite(contribution)) return false;
    RayData shadow = make_shadow_ray(point, drawn, lift, ray.lod_bias);
    uint body = find_next_body(path, scattering, point, material_index, shadow.direction);
    if (kHasGlass != 0u && body != kNone) contribution *= absorb_along(materials[body].glass.depth, shadow.t_max);
    if (is_caught) film[path_index].shadow.z += luminance(contribution);
    paths[path_index].contribution = clamp_indirect(contribution, push.clamp_indirect, push.depth);
    paths[path_index].cost = path.cost + 1.0;
    if (kLightKinds != 0u && push.depth == 0u)
        store_light_shares(push.capacity, path_index, find_light_shares(scattering, wi, bsdf.value));
    store_light_group(push.capacity, path_index, drawn.group);
    if (kTerminators != 0u) {
        paths[path_index].lifted_direction = shadow.direction;
        paths[path_index].lifted_distance = is_lifted ? shadow.t_max : 0.0;
        vec3 origin = point.position + point.geometric_normal * point.position_error;
        if (is_lifted) shadow = RayData(origin, 0.0, point.geometric_normal, lift, ray.lod_bias);
    }
    rays[push.capacity + path_index] = shadow;
    return true;
}

/// Takes what a body took on the way, and what goes with the choice between glass and the rest.
PathData meet_glass(uint path_index, PathData path, HitData hit, SurfacePointData point, uint material_index) {
    MaterialData material = load_vertex_material(material_index, push.capacity, path_index).numbers;
    vec3 factor = vec3(1.0);
    if (material.has_glass != 0u && material.glass.kind == kSolidGlass) {
        if (point.is_flipped != 0u) path.body = material_index;
        // Met from outside, whatever the path took for true: at a fold of the surface, say.
        if (point.is_flipped == 0u && path.body == material_index) path.body = kNone;
    }
    if (path.body != kNone) factor = absorb_along(materials[path.body].glass.depth, hit.t);
    if (material.has_glass != 0u) {
        vec2 pick = draw_bounce_pair(path.pixel_seed, push.sample_index, push.depth, kPickPair);
        factor *= draw_vertex_glass(point, material, -rays[path_index].direction, pick.y).weight;
    }
    path.throughput *= factor;
    paths[path_index].throughput = path.throughput;
    paths[path_index].body = path.body;
    return path;
}

/// To the layers of light.
void share_emission(uint path_index, vec3 light, uint group) {
    add_to_group(push.capacity, path_index, group, light);
    if (push.depth == 0u)
        add_to_kind(push.capacity, path_index, kKindEmission, light);
    else
        add_scattered(push.capacity, path_index, light, push.depth - 1u);
}

GuideVertex make_guide_vertex(uint path_index, PathData path, SurfacePointData point, MaterialData material) {
    GuideVertex vertex = {point.base_color, material.emission, point.roughness, point.metallic, false};
    if (kHasGlass != 0u && material.has_glass != 0u) {
        vec2 pick = draw_bounce_pair(path.pixel_seed, push.sample_index, push.depth, kPickPair);
        GlassDraw drawn = draw_vertex_glass(point, material, -rays[path_index].direction, pick.y);
        vertex.is_glass = drawn.is_glass;
        vertex.metallic = drawn.metallic;
    }
    if (kHasLayers != 0u && material.has_layers != 0u && !vertex.is_glass)
        vertex.roughness = roughen_base(point.roughness, material.layers);
    return vertex;
}

void note_guides(uint path_index, PathData path, SurfacePointData point, MaterialData material) {
    GuideVertex vertex = make_guide_vertex(path_index, path, point, material);
    bool goes_on = push.depth + 1u < push.last_depth && is_mirror(vertex);
    note_guided(push.capacity, path_index, !goes_on);
    if (!goes_on)
        add_guides(push.capacity, path_index, find_guide_albedo(path.throughput, find_guide_color(vertex)),
                   point.bent_normal);
}

/// True if there is a shadow ray.
bool light_vertex(uint path_index, HitData hit) {
    PathData path = paths[path_index];
    SurfacePointData point = points[path_index];
    uint material_index = instances[hit.instance].material;
    if (kHasGlass != 0u && !is_catcher(hit, push.depth))
        path = meet_glass(path_index, path, hit, point, material_index);
    MaterialData material = load_material(path_index, hit).numbers;
    vec3 emission = find_emission(path, hit, point, material.emission);
    paths[path_index].radiance = path.radiance + emission;
    share_emission(path_index, emission, material.light_group);
    if (looks_for_guides(push.capacity, path_index, push.depth)) note_guides(path_index, path, point, material);
    // The last rays look for light alone.
    if (push.depth > 0u && push.depth == push.last_depth) return false;
    return (push.source_count > 0u || kHasLightTree != 0u) && sample_light(path_index, path, point, hit);
}

void main() {
    uint index = invocation_index();
    if (index >= push.count) return;
    uint path_index = path_list[index];
    HitData hit = hits[path_index];
    uint count = is_hit(hit) && light_vertex(path_index, hit) ? 1u : 0u;
    uint place = atomicAdd(counters.shadow_count, count);
    if (count > 0u) shadow_list[place] = push.capacity + path_index;
}
