// Samples the next ray of each path, up to where it sees a coarser surface, or terminates it.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/paths.glsl"
#include "vulkan/shaders/light_sums.glsl"
#include "vulkan/shaders/surface_point.glsl"

layout(scalar, push_constant) uniform Push { PathPush push; };

/// Sets the next ray; false if the path terminates.
bool continue_path(const uint path_index, const HitData hit) {
    SurfacePointData point = points[path_index];
    uint pixel_seed = paths[path_index].pixel_seed;
    vec2 pick = draw_bounce_pair(pixel_seed, push.sample_index, push.depth, kPickPair);
    vec2 u = draw_bounce_pair(pixel_seed, push.sample_index, push.depth, kBsdfPair);
    vec2 last = draw_bounce_pair(pixel_seed, push.sample_index, push.depth, kRoulettePair);
    uint material = instances[hit.instance].material;
    Scattering scattering = make_scattering(
        point, load_vertex_material(material, push.capacity, path_index), -rays[path_index].direction, pick.y);
    BsdfSample drawn = sample_scattering(scattering, u);
    vec3 direction = make_unit(from_local(scattering.basis, drawn.direction));
    if (drawn.weight == vec3(0.0) || !is_on_one_side(scattering, point, direction, drawn.direction)) return false;
    PathData path = paths[path_index];
    vec3 throughput = path.throughput * drawn.weight;
    uint body = find_next_body(path, scattering, point, material, direction);
    bool is_inside = kHasGlass != 0u && body != kNone;
    // Inside, radiance is larger by the square of the ior.
    float ior = is_inside ? materials[body].glass.ior : 1.0;
    float probability = survival_probability(push.depth, throughput * (ior * ior));
    if (!is_finite(throughput) || last.x >= probability) return false;
    paths[path_index].throughput = throughput * (1.0 / probability);
    paths[path_index].previous = point.position;
    if (kHasLightTree != 0u) paths[path_index].normal = point.geometric_normal;
    if (kHasLightLinks != 0u) paths[path_index].instance = hit.instance;
    paths[path_index].bsdf_pdf = drawn.pdf;
    paths[path_index].cost = path.cost + 1.0;
    if (kHasGlass != 0u) paths[path_index].body = body;
    if (kLightKinds != 0u && push.depth == 0u)
        store_bounce_shares(push.capacity, path_index,
                            find_light_shares(scattering, drawn.direction, drawn.weight * drawn.pdf));
    vec3 origin = offset_origin(point.position, point.geometric_normal, point.position_error, direction);
    uint lod_bias = rays[path_index].lod_bias;
    float near_end = find_coarse_distance(push.bounce_lod, origin, lod_bias, drawn.pdf);
    // Within a body, between the two surfaces there would be a way in, or none out.
    float height = dot(point.geometric_normal, direction) * (point.is_flipped != 0u ? -1.0 : 1.0);
    if (is_inside || height < 0.0) near_end = make_infinity();
    RayData next = {origin, 0.0, direction, near_end, lod_bias};
    rays[path_index] = next;
    return true;
}

void main() {
    uint index = invocation_index();
    if (index >= push.count) return;
    uint path_index = path_list[index];
    HitData hit = hits[path_index];
    bool goes_on = is_hit(hit) && !is_catcher(hit, push.depth) && continue_path(path_index, hit);
    uint count = goes_on ? 1u : 0u;
    uint place = atomicAdd(counters.path_count, count);
    if (count > 0u) next_path_list[place] = path_index;
}
