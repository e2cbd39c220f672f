// Light drawn at a vertex: next-event estimation, whose shadow ray is traced later.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/paths.glsl"
#include "vulkan/shaders/environment_light.glsl"
#include "vulkan/shaders/lights.glsl"
#include "vulkan/shaders/surface_point.glsl"
#include "vulkan/shaders/light_sums.glsl"
#include "vulkan/shaders/terminator.glsl"
#include "vulkan/shaders/input_look_up.glsl"

layout(scalar, push_constant) uniform Push { PathPush push; };

/// A light sampled for one vertex.
struct DrawnLight {
    LightDraw light;
    bool is_surface;
    vec3 end; ///< of the shadow ray, just short of an emissive surface
    uint group;
};

/// `is_open`: light from behind the surface counts.
DrawnLight draw_from_environment(const vec3 normal, const bool is_open, const vec2 u) {
    EnvironmentDraw drawn = draw_environment_direction(push.environment, u);
    DrawnLight result = {{drawn.direction, make_infinity(), vec3(0.0), 0.0}, false, vec3(0.0), kNone};
    // Early out without reading the image: half of the directions point into the surface.
    if (!(drawn.pdf > 0.0) || (!is_open && dot(drawn.direction, normal) <= 0.0)) return result;
    result.light.weight = environment_radiance_at(push.environment, drawn.position) * (1.0 / drawn.pdf);
    result.light.pdf = drawn.pdf;
    return result;
}

DrawnLight draw_from_emitter(const vec3 position, const uint lod_bias, const uint emitter, const vec2 u) {
    uvec2 range = find_emitter_range(push.emitter_count, push.emitter_range_count, 0u, emitter);
    InstanceData instance = instances[range.y];
    uint patch_index = emitter - range.x;
    bool is_polygon = is_triangle(load_quad(surfaces[instance.surface], patch_index));
    CellPoint point = evaluate_point(range.y, patch_index, is_polygon ? square_to_triangle(u) : u, lod_bias);
    vec3 to = point.triangle.position - position;
    float pdf =
        emitter_density(load_probability(emitter), point.triangle.area_per_uv, point.triangle.normal, to);
    MaterialData material = materials[instance.material];
    if (kHasVertexNumbers != 0u && material.has_vertex_numbers != 0u) {
        vec2 at = is_polygon ? square_to_triangle(u) : u;
        InputNumbers numbers = find_inputs_at(material_inputs[material.inputs], kEmissionPlace, instance, patch_index, at);
        material.emission = get_input_color(numbers, kInputEmission);
    }
    DrawnLight result = {draw_emitter(material.emission, to, pdf), true, vec3(0.0), kNone};
    result.end =
        offset_origin(point.triangle.position, point.triangle.normal, point.position_error, -result.light.direction);
    result.group = material.light_group;
    return result;
}

DrawnLight draw_from(const LightPick pick, const SurfacePointData at, const bool is_open, const uint lod_bias,
                     const float u_emitter, const vec2 u) {
    uint emitter = kHasLightTree != 0u && pick.source == kNone ? pick.emitter : kNone;
    LightSourceData source;
    if (emitter == kNone) {
        source = sources[pick.source];
        if (source.kind == kSourceEnvironment) return draw_from_environment(at.geometric_normal, is_open, u);
        if (source.kind == kSourceEmitters) emitter = find_emitter(push.emitter_count, u_emitter);
    }
    if (emitter != kNone) return draw_from_emitter(at.position, lod_bias, emitter, u);
    DrawnLight result = {draw_listed_light(source, at.position, u), false, vec3(0.0), kNone};
    if (has_texture(source) && result.light.pdf > 0.0)
        result.light.weight *= find_light_color(source, at.position, result.light.direction);
    return result;
}

/// Selects a light in proportion to its estimated irradiance, then a direction; density 0: no sample.
DrawnLight draw_light(const SurfacePointData at, const uint instance, const bool is_open, const uint lod_bias,
                      const vec2 pick_and_emitter, const vec2 u) {
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

/// `lift`: how far the ray starts above the triangle, where the light comes from below it.
RayData make_shadow_ray(const SurfacePointData point, const DrawnLight drawn, const float lift, const uint lod_bias) {
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

/// Whether light from behind the surface may count.
bool is_open_behind(const HitData hit, const uint material_index) {
    if (may_lift(hit)) return true;
    return kHasGlass != 0u && !is_catcher(hit, push.depth) && is_see_through(materials[material_index]);
}

/// Sets the shadow ray and its contribution; false if zero. MIS weight 1 without bounces and on shadow catchers: no
/// other ray finds lights. Materials are read behind the light, and the BSDF is made last: both are large.
bool sample_light(const uint path_index, const HitData hit) {
    uint pixel_seed = paths[path_index].pixel_seed;
    uint lod_bias = rays[path_index].lod_bias;
    uint material_index = instances[hit.instance].material;
    bool is_open = is_open_behind(hit, material_index);
    vec2 pick = draw_bounce_pair(pixel_seed, push.sample_index, push.depth, kPickPair);
    vec2 u = draw_bounce_pair(pixel_seed, push.sample_index, push.depth, kLightPair);
    vec2 last = draw_bounce_pair(pixel_seed, push.sample_index, push.depth, kRoulettePair);
    DrawnLight drawn = draw_light(points[path_index], hit.instance, is_open, lod_bias, vec2(pick.x, last.y), u);
    if (!(drawn.light.pdf > 0.0)) return false;
    float lift = find_light_lift(hit, points[path_index].geometric_normal, drawn.light.direction);
    SurfacePointData point = points[path_index];
    Scattering scattering = make_scattering(point, load_lit_material(path_index, hit, push.capacity, push.depth),
                                            -rays[path_index].direction, pick.y);
    vec3 wi = to_local(scattering.basis, drawn.light.direction);
    if (scattering.is_glass) lift = 0.0;
    bool is_lifted = lift > 0.0;
    if (is_open && !is_lifted && !is_on_one_side(scattering, point, drawn.light.direction, wi)) return false;
    BsdfValue bsdf = evaluate_scattering(scattering, wi);
    // No other ray finds light from below the triangle.
    bool is_caught = is_catcher(hit, push.depth);
    bool is_below = is_lifted && dot(drawn.light.direction, point.geometric_normal) <= 0.0;
    bool is_alone = push.last_depth == 0u || is_below || is_caught;
    float weight = is_alone ? 1.0 : power_heuristic(drawn.light.pdf, bsdf.pdf);
    PathData path = paths[path_index];
    vec3 contribution = path.throughput * bsdf.value * drawn.light.weight * weight;
    if (contribution == vec3(0.0) || !is_finite(contribution)) return false;
    if (kLightKinds != 0u && push.depth == 0u)
        store_light_shares(push.capacity, path_index, find_light_shares(scattering, wi, bsdf.value));
    RayData shadow = make_shadow_ray(point, drawn, lift, lod_bias);
    uint body = find_next_body(path, scattering, point, material_index, shadow.direction);
    if (kHasGlass != 0u && body != kNone) contribution *= absorb_along(materials[body].glass.depth, shadow.t_max);
    if (is_caught) film[path_index].shadow.z += luminance(contribution);
    paths[path_index].contribution = clamp_indirect(contribution, push.clamp_indirect, push.depth);
    paths[path_index].cost = path.cost + 1.0;
    store_light_group(push.capacity, path_index, drawn.group);
    if (kTerminators != 0u) {
        paths[path_index].lifted_direction = shadow.direction;
        paths[path_index].lifted_distance = is_lifted ? shadow.t_max : 0.0;
        vec3 origin = point.position + point.geometric_normal * point.position_error;
        if (is_lifted) shadow = RayData(origin, 0.0, point.geometric_normal, lift, lod_bias);
    }
    rays[push.capacity + path_index] = shadow;
    return true;
}

void main() {
    uint index = invocation_index();
    if (index >= push.count) return;
    uint path_index = path_list[index];
    HitData hit = hits[path_index];
    uint count = is_hit(hit) && sample_light(path_index, hit) ? 1u : 0u;
    uint place = atomicAdd(counters.shadow_count, count);
    if (count > 0u) shadow_list[place] = push.capacity + path_index;
}
