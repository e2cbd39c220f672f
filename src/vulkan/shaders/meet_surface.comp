// What a path meets at a surface: emission, the glass that it goes through, guides.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/paths.glsl"
#include "vulkan/shaders/lights.glsl"
#include "vulkan/shaders/light_sums.glsl"
#include "formulas/guides.h"

layout(scalar, push_constant) uniform Push { PathPush push; };

/// Density with which draw_light at the previous vertex would have sampled this point.
float emitter_pdf(const PathData path, const HitData hit, const SurfacePointData point) {
    if (push.emitter_range_count == 0u) return 0.0;
    uint emitter =
        find_emitter_range(push.emitter_count, push.emitter_range_count, 1u, hit.instance).x + hit.patch_index;
    LitPoint previous = {path.previous, path.normal, path.instance};
    uint leaf = kHasLightTree != 0u ? texelFetch(emitter_table, int(emitter)).y : kNone;
    return find_emitter_probability(push.source_count, push.first_light_node, previous, leaf) *
           emitter_density(load_probability(emitter), point.area_per_uv, point.geometric_normal,
                           point.position - path.previous);
}

vec3 find_emission(const PathData path, const HitData hit, const SurfacePointData point, const vec3 emission) {
    if (emission == vec3(0.0)) return vec3(0.0);
    if (push.depth == 0u) return path.throughput * emission;
    vec3 light = path.throughput * emission * power_heuristic(path.bsdf_pdf, emitter_pdf(path, hit, point));
    return clamp_indirect(light, push.clamp_indirect, push.depth - 1u);
}

/// Takes what a body took on the way, and what goes with the choice between glass and the rest.
PathData meet_glass(const uint path_index, PathData path, const HitData hit, const SurfacePointData point,
                    const uint material_index) {
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
void share_emission(const uint path_index, const vec3 light, const uint group) {
    add_to_group(push.capacity, path_index, group, light);
    if (push.depth == 0u)
        add_to_kind(push.capacity, path_index, kKindEmission, light);
    else
        add_scattered(push.capacity, path_index, light, push.depth - 1u);
}

GuideVertex make_guide_vertex(const uint path_index, const PathData path, const SurfacePointData point,
                              const MaterialData material) {
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

void note_guides(const uint path_index, const PathData path, const SurfacePointData point,
                 const MaterialData material) {
    GuideVertex vertex = make_guide_vertex(path_index, path, point, material);
    bool goes_on = push.depth + 1u < push.last_depth && is_mirror(vertex);
    note_guided(push.capacity, path_index, !goes_on);
    if (!goes_on)
        add_guides(push.capacity, path_index, find_guide_albedo(path.throughput, find_guide_color(vertex)),
                   point.bent_normal);
}

void meet_surface(const uint path_index, const HitData hit) {
    PathData path = paths[path_index];
    SurfacePointData point = points[path_index];
    uint material_index = instances[hit.instance].material;
    if (kHasGlass != 0u && !is_catcher(hit, push.depth))
        path = meet_glass(path_index, path, hit, point, material_index);
    MaterialData material = load_lit_material(path_index, hit, push.capacity, push.depth).numbers;
    vec3 emission = find_emission(path, hit, point, material.emission);
    paths[path_index].radiance = path.radiance + emission;
    share_emission(path_index, emission, material.light_group);
    if (looks_for_guides(push.capacity, path_index, push.depth)) note_guides(path_index, path, point, material);
}

void main() {
    uint index = invocation_index();
    if (index >= push.count) return;
    uint path_index = path_list[index];
    HitData hit = hits[path_index];
    if (is_hit(hit)) meet_surface(path_index, hit);
}
