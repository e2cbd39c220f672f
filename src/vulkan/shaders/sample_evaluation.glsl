// One sample of a displaced patch with few values at hand at any time, for kernels whose invocations evaluate
// different patches: the float operations of patch_evaluation.glsl in the same order, but vertices are added up one
// after another, tables are read where they are needed, and frames last.
#ifndef RELIEF_SAMPLE_EVALUATION_GLSL
#define RELIEF_SAMPLE_EVALUATION_GLSL

#include "vulkan/shaders/patch_evaluation.glsl"

/// What a sample lies between, before displacement: the two ends of a line, or the four corners of a patch.
struct SamplePlace {
    uvec4 vertices; ///< in the order 00 10 11 01; first two: of a line
    vec2 at;
    bool is_line;
    uvec2 controls; ///< inner control points of a line on a bicubic base; kNone at a corner
    uint mip_place; ///< of the patch's mips
};

/// In the order in which vertices are added up: row by row.
uint get_vertex(const SamplePlace place, const uint k) { return place.vertices[k ^ (k >> 1u)]; }
uint count_vertices(const SamplePlace place) { return place.is_line ? 2u : 4u; }

/// The sum of a row with one vertex more: blend().
vec3 add_to_row(const vec3 row, const vec3 value, const SamplePlace place, const uint k) {
    bool is_first = (k & 1u) == 0u;
    vec3 term = scale_exact(value, is_first ? 1.0 - place.at.x : place.at.x);
    return is_first ? term : add_exact(row, term);
}

/// The sum of both rows behind vertex `k`, or that of the line: blend_quad() or blend().
vec3 add_row(const vec3 sum, const vec3 row, const SamplePlace place, const uint k) {
    if (place.is_line) return row;
    if ((k & 1u) == 0u) return sum;
    vec3 term = scale_exact(row, k == 1u ? 1.0 - place.at.y : place.at.y);
    return k == 1u ? term : add_exact(sum, term);
}

vec3 blend_positions(const SurfaceData s, const SamplePlace place) {
    vec3 row = vec3(0.0);
    vec3 sum = vec3(0.0);
    for (uint k = 0u; k < count_vertices(place); ++k) {
        row = add_to_row(row, load_position(s, get_vertex(place, k)), place, k);
        sum = add_row(sum, row, place, k);
    }
    return sum;
}

vec2 blend_uvs(const SurfaceData s, const SamplePlace place) {
    vec3 row = vec3(0.0);
    vec3 sum = vec3(0.0);
    if (s.first_uv == kNone) return vec2(0.0);
    for (uint k = 0u; k < count_vertices(place); ++k) {
        row = add_to_row(row, vec3(load_uv(s, get_vertex(place, k)), 0.0), place, k);
        sum = add_row(sum, row, place, k);
    }
    return sum.xy;
}

TangentFrame blend_frames(const SurfaceData s, const SamplePlace place) {
    TangentFrame row = TangentFrame(vec3(0.0), vec3(0.0), vec3(0.0));
    TangentFrame sum = row;
    for (uint k = 0u; k < count_vertices(place); ++k) {
        TangentFrame frame = load_frame(s, get_vertex(place, k));
        row.t = add_to_row(row.t, frame.t, place, k);
        row.b = add_to_row(row.b, frame.b, place, k);
        row.n = add_to_row(row.n, frame.n, place, k);
        sum.t = add_row(sum.t, row.t, place, k);
        sum.b = add_row(sum.b, row.b, place, k);
        sum.n = add_row(sum.n, row.n, place, k);
    }
    return sum;
}

/// evaluate_base(), column by column: the outer ones first, as blend_cubic() adds.
vec3 sum_base(const SurfaceData s, const uvec4 quad, const uint patch_index, const vec2 at) {
    CubicWeights across = weigh_cubic(at.y);
    CubicWeights along = weigh_cubic(at.x);
    vec3 ends = vec3(0.0);
    vec3 inner = vec3(0.0);
    for (uint k = 0u; k < 4u; ++k) {
        uint column = k == 0u ? 0u : k == 1u ? 3u : k - 1u;
        vec3 point = blend_cubic_vectors(load_control(s, quad, patch_index, find_control_point(column, 0u)),
                                         load_control(s, quad, patch_index, find_control_point(column, 1u)),
                                         load_control(s, quad, patch_index, find_control_point(column, 2u)),
                                         load_control(s, quad, patch_index, find_control_point(column, 3u)), across);
        vec3 term = scale_exact(point, k == 0u   ? along.first
                                       : k == 1u ? along.fourth
                                       : k == 2u ? along.second
                                                 : along.third);
        if (k == 0u) ends = term;
        if (k == 1u) ends = add_exact(ends, term);
        if (k == 2u) inner = term;
        if (k == 3u) inner = add_exact(inner, term);
    }
    return add_exact(ends, inner);
}

vec3 find_undisplaced(const SurfaceData s, const uvec4 quad, const uint patch_index, const SamplePlace place) {
    if (!is_bicubic(s) || (place.is_line && place.controls.x == kNone)) return blend_positions(s, place);
    if (!place.is_line) return sum_base(s, quad, patch_index, place.at);
    return blend_cubic_vectors(load_position(s, place.vertices.x), load_control(s, quad, patch_index, place.controls.x),
                               load_control(s, quad, patch_index, place.controls.y), load_position(s, place.vertices.y),
                               weigh_cubic(place.at.x));
}

SamplePlace make_line_place(const LinePlace line) {
    return SamplePlace(uvec4(line.first, line.second, 0u, 0u), vec2(line.s, 0.0), true,
                       uvec2(line.control, line.end_control), line.mip_place);
}

/// Of sample (i, j) of a patch.
SamplePlace place_sample(const SurfaceData s, const uvec4 quad, const uint patch_index, const uint packed_levels,
                         const uint i, const uint j) {
    uint level = packed_patch_level(packed_levels);
    uint n = 1u << level;
    bool is_on_u_edge = j == 0u || j == n;
    bool is_on_v_edge = i == 0u || i == n;
    if (is_on_u_edge && is_on_v_edge)
        return make_line_place(find_corner(s, quad, find_grid_corner(i, j)));
    if (is_on_u_edge || is_on_v_edge)
        return make_line_place(
            find_edge_place(s, quad, patch_index, packed_levels, uvec3(i, j, find_sample_edge(i, j, level))));
    float cell = 1.0 / float(n);
    return SamplePlace(quad, vec2(float(i) * cell, float(j) * cell), false, uvec2(kNone), kMipInside);
}

/// Sample (i, j) of a patch at its levels, object space: the definition of the surface.
vec3 find_sample(const SurfaceData s, const uint patch_index, const uint packed_levels, const uint i, const uint j) {
    uvec4 quad = load_quad(s, patch_index);
    SamplePlace place = place_sample(s, quad, patch_index, packed_levels, i, j);
    vec3 position = find_undisplaced(s, quad, patch_index, place);
    if (s.map == kNone) return position;
    uint mip = packed_mip(load_mips(s, patch_index), place.mip_place);
    vec3 d = fetch_displacement(maps[s.map], load_vertex_tile(s, place.vertices.x), mip, blend_uvs(s, place));
    if (maps[s.map].is_tangent == 0u) return add_exact(position, d);
    TangentFrame frame = s.first_frame == kNone ? TangentFrame(vec3(0.0), vec3(0.0), vec3(0.0)) : blend_frames(s, place);
    return add_exact(position, vec3(carry_through_frame(d.x, d.y, d.z, frame.t.x, frame.b.x, frame.n.x),
                                    carry_through_frame(d.x, d.y, d.z, frame.t.y, frame.b.y, frame.n.y),
                                    carry_through_frame(d.x, d.y, d.z, frame.t.z, frame.b.z, frame.n.z)));
}

#endif
