// Position, geometric normal and area at hits. First hits are added to the layers.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/paths.glsl"
#include "vulkan/shaders/surface_point.glsl"

layout(scalar, push_constant) uniform Push { PathPush push; };
layout(scalar, set = 0, binding = kBindFilm) buffer FirstHits { uint first_hits[]; };

void make_point(const uint path_index, const HitData hit) {
    CellPoint found = evaluate_hit(hit);
    bool is_flipped = dot(found.triangle.normal, rays[path_index].direction) > 0.0;
    points[path_index].position = found.triangle.position;
    points[path_index].position_error = found.position_error;
    points[path_index].geometric_normal = is_flipped ? -found.triangle.normal : found.triangle.normal;
    points[path_index].area_per_uv = found.triangle.area_per_uv;
    points[path_index].is_flipped = is_flipped ? 1u : 0u;
}

void record_first_hit(const uint pixel, const HitData hit) {
    film[pixel].hit_count += 1.0;
    film[pixel].geometric_normal += points[pixel].geometric_normal;
    film[pixel].position += points[pixel].position;
    FilmSumsData sums = film[pixel];
    uint id = hit.instance + 1u;
    if (push.first_hit_offset != 0u) first_hits[push.first_hit_offset + pixel] = id;
    if (sums.id != 0u && (hit.t > sums.depth || (hit.t == sums.depth && id >= sums.id))) return;
    film[pixel].depth = hit.t;
    film[pixel].id = id;
}

void main() {
    uint index = invocation_index();
    if (index >= push.count) return;
    uint path_index = path_list[index];
    HitData hit = hits[path_index];
    if (!is_hit(hit)) return;
    make_point(path_index, hit);
    if (push.depth > 0u) return;
    if (is_catcher(hit, push.depth))
        film[path_index].shadow.x += 1.0;
    else
        record_first_hit(path_index, hit);
}
