// Vertices of a displaced patch, as evaluate_vertex (surface/patch/patch_samples.cpp) makes them.
#ifndef RELIEF_PATCH_EVALUATION_GLSL
#define RELIEF_PATCH_EVALUATION_GLSL

#include "vulkan/shaders/scene.glsl"
#include "vulkan/shaders/tile_texels.glsl"

/// Attributes interpolated over a patch; the frame is zero unless the map is in tangent space.
struct VertexData {
    vec3 position;
    vec2 uv;
    vec3 t, b, n;
    uint tile;
};

/// Not for surfaces without frames.
TangentFrame load_frame(const SurfaceData s, const uint vertex) {
    if (s.first_derivative != kNone)
        return TangentFrame(load_position_at(s.first_derivative + 2u * vertex),
                            load_position_at(s.first_derivative + 2u * vertex + 1u), load_normal(s, vertex));
    uvec2 packed_frame = texelFetch(frames, int(s.first_frame + vertex)).xy;
    return unpack_tangent_frame(packed_frame.x, packed_frame.y);
}

VertexData load_vertex(const SurfaceData s, const uint vertex) {
    VertexData data;
    data.position = load_position(s, vertex);
    data.uv = s.first_uv == kNone ? vec2(0.0) : load_uv(s, vertex);
    data.t = data.b = data.n = vec3(0.0);
    if (s.map != kNone && s.first_frame != kNone && maps[s.map].is_tangent != 0u) {
        TangentFrame frame = load_frame(s, vertex);
        data.t = frame.t;
        data.b = frame.b;
        data.n = frame.n;
    }
    data.tile = load_vertex_tile(s, vertex);
    return data;
}

vec3 decode_displacement(const MapData map, const vec3 value) {
    precise vec3 raw = value - map.midlevel;
    return vec3(decode_row(raw.x, raw.y, raw.z, map.row0.x, map.row0.y, map.row0.z),
                decode_row(raw.x, raw.y, raw.z, map.row1.x, map.row1.y, map.row1.z),
                decode_row(raw.x, raw.y, raw.z, map.row2.x, map.row2.y, map.row2.z));
}

/// Value of a B-spline in the cell of coefficients that begins in column `left` and row `top`.
vec3 fetch_spline(const MapImage image, const MapData map, const int left, const int top, const vec2 fraction) {
    CubicWeights along = weigh_spline(fraction.x);
    vec3 point[4];
    for (int j = 0; j < 4; ++j) {
        int row = top + j - 1;
        int wrapped_row = wrap_texel(row, int(image.texels.height), map.wrap);
        vec3 coefficient[4];
        for (int i = 0; i < 4; ++i) {
            int column = left + i - 1;
            ivec2 wrapped = ivec2(wrap_texel(column, int(image.texels.width), map.wrap), wrapped_row);
            coefficient[i] = load_map_texel(image, map, ivec2(column, row), wrapped);
        }
        point[j] = blend_cubic_vectors(coefficient[0], coefficient[1], coefficient[2], coefficient[3], along);
    }
    return blend_cubic_vectors(point[0], point[1], point[2], point[3], weigh_spline(fraction.y));
}

/// Displacement at a local uv of mip level `mip` of a tile; zero for a missing tile.
vec3 fetch_displacement(const MapData map, const uint tile, const uint mip, const vec2 uv) {
    if (tile >= map.tile_count) return vec3(0.0);
    MapImage image = MapImage(textures[map.first_tile + mip * map.tile_count + tile], tile, mip);
    int width = int(image.texels.width);
    int height = int(image.texels.height);
    precise float x = uv.x * float(width) - 0.5;
    precise float y = (map.flip_v != 0u ? uv.y : 1.0 - uv.y) * float(height) - 0.5;
    // Beyond 2^30 a float does not resolve texels.
    float x0 = clamp(floor_texel(x), -1073741824.0, 1073741760.0);
    float y0 = clamp(floor_texel(y), -1073741824.0, 1073741760.0);
    precise float fx = x - x0;
    precise float fy = y - y0;
    if (kHasSmooth != 0 && map.is_smooth != 0u)
        return decode_displacement(map, fetch_spline(image, map, int(x0), int(y0), vec2(fx, fy)));
    ivec2 low = ivec2(int(x0), int(y0));
    int left = wrap_texel(low.x, width, map.wrap);
    int right = wrap_texel(low.x + 1, width, map.wrap);
    int top = wrap_texel(low.y, height, map.wrap);
    int bottom = wrap_texel(low.y + 1, height, map.wrap);
    vec3 t00 = load_map_texel(image, map, low, ivec2(left, top));
    vec3 t10 = load_map_texel(image, map, low + ivec2(1, 0), ivec2(right, top));
    vec3 t01 = load_map_texel(image, map, low + ivec2(0, 1), ivec2(left, bottom));
    vec3 t11 = load_map_texel(image, map, low + ivec2(1, 1), ivec2(right, bottom));
    vec3 value = vec3(filter_texels(t00.x, t10.x, t01.x, t11.x, fx, fy),
                      filter_texels(t00.y, t10.y, t01.y, t11.y, fx, fy),
                      filter_texels(t00.z, t10.z, t01.z, t11.z, fx, fy));
    return decode_displacement(map, value);
}

/// Displaces interpolated attributes by mip level `mip` of the map.
vec3 displace(const SurfaceData s, const VertexData base, const uint mip) {
    if (s.map == kNone) return base.position;
    MapData map = maps[s.map];
    vec3 d = fetch_displacement(map, base.tile, mip, base.uv);
    if (map.is_tangent == 0u) return add_exact(base.position, d);
    vec3 offset = vec3(carry_through_frame(d.x, d.y, d.z, base.t.x, base.b.x, base.n.x),
                       carry_through_frame(d.x, d.y, d.z, base.t.y, base.b.y, base.n.y),
                       carry_through_frame(d.x, d.y, d.z, base.t.z, base.b.z, base.n.z));
    return add_exact(base.position, offset);
}

vec3 blend_vectors(const vec3 a, const vec3 b, const float s) {
    return vec3(blend(a.x, b.x, s), blend(a.y, b.y, s), blend(a.z, b.z, s));
}
vec3 blend_quad_vectors(const vec3 a, const vec3 b, const vec3 c, const vec3 d, const float u, const float v) {
    return vec3(blend_quad(a.x, b.x, c.x, d.x, u, v), blend_quad(a.y, b.y, c.y, d.y, u, v),
                blend_quad(a.z, b.z, c.z, d.z, u, v));
}

layout(constant_id = kBicubicConstant) const uint kHasBicubic = 0;

bool is_bicubic(const SurfaceData s) { return kHasBicubic != 0u && s.first_control != kNone; }

/// Control point of a bicubic patch (formulas/control_points.h).
vec3 load_control(const SurfaceData s, const uvec4 quad, const uint patch_index, const uint number) {
    if (number < 4u) return load_position(s, quad[number]);
    return load_position_at(s.first_control + kInnerControlCount * patch_index + number - 4u);
}

/// Point (u, v) of a bicubic base.
vec3 evaluate_base(const SurfaceData s, const uvec4 quad, const uint patch_index, const float u, const float v) {
    CubicWeights across = weigh_cubic(v);
    vec3 point[4];
    for (uint column = 0u; column < 4u; ++column) {
        vec3 control[4];
        for (uint row = 0u; row < 4u; ++row)
            control[row] = load_control(s, quad, patch_index, find_control_point(column, row));
        point[column] = blend_cubic_vectors(control[0], control[1], control[2], control[3], across);
    }
    return blend_cubic_vectors(point[0], point[1], point[2], point[3], weigh_cubic(u));
}

/// Derivative of a bicubic base along u, or along v where `direction` is 1.
vec3 differentiate_base(const SurfaceData s, const uvec4 quad, const uint patch_index, const vec2 at,
                        const uint direction) {
    CubicWeights weights = weigh_cubic(direction == 0u ? at.y : at.x);
    vec3 difference[3];
    for (uint k = 0u; k < 3u; ++k) {
        vec3 control[4];
        for (uint c = 0u; c < 4u; ++c) {
            uint low = direction == 0u ? find_control_point(k, c) : find_control_point(c, k);
            uint high = direction == 0u ? find_control_point(k + 1u, c) : find_control_point(c, k + 1u);
            control[c] = load_control(s, quad, patch_index, high) - load_control(s, quad, patch_index, low);
        }
        difference[k] = blend_cubic_vectors(control[0], control[1], control[2], control[3], weights);
    }
    float along = direction == 0u ? at.x : at.y;
    return vec3(blend_slope(difference[0].x, difference[1].x, difference[2].x, along),
                blend_slope(difference[0].y, difference[1].y, difference[2].y, along),
                blend_slope(difference[0].z, difference[1].z, difference[2].z, along));
}

struct EdgeLine {
    uint first, second;
    bool is_reversed;
};

/// Ends of the line at a uv seam: those of the side with the lower index.
uvec2 find_override(const SurfaceData s, const uint patch_edge) {
    uint low = s.first_override;
    uint high = s.first_override + s.override_count - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (texelFetch(overrides, int(middle)).x < patch_edge)
            low = middle + 1u;
        else
            high = middle;
    }
    return texelFetch(overrides, int(low)).yz;
}

EdgeLine find_edge_line(const SurfaceData s, const uvec4 quad, const uint patch_index, const uint edge) {
    uint first = quad[edge];
    uint second = quad[(edge + 1u) & 3u];
    if (is_seam(s, patch_index, edge)) {
        uvec2 ends = find_override(s, 4u * patch_index + edge);
        first = ends.x;
        second = ends.y;
    }
    uint first_dominant = load_dominant(s, first);
    uint second_dominant = load_dominant(s, second);
    bool is_reversed =
        second_dominant < first_dominant || (second_dominant == first_dominant && second < first);
    if (is_reversed) return EdgeLine(second, first, true);
    return EdgeLine(first, second, false);
}

/// A boundary sample: the ends of a line and the position between. Corners use their dominant vertex only.
struct LinePlace {
    uint first, second;
    float s;
    uint control;     ///< inner control point beside `first` where the base is bicubic; kNone at a corner
    uint end_control; ///< beside `second`
    uint mip_place;   ///< of the patch's mips
};

LinePlace find_corner(const SurfaceData s, const uvec4 quad, const uint k) {
    uint vertex = load_dominant(s, quad[k]);
    return LinePlace(vertex, vertex, 0.0, kNone, kNone, kMipCorners + k);
}

/// Corner of a grid of n x n cells that sample (i, j) is.
uint find_grid_corner(const uint i, const uint j) { return j == 0u ? (i == 0u ? 0u : 1u) : (i == 0u ? 3u : 2u); }

/// A sample of an edge after snapping.
struct EdgeSample {
    uint corner; ///< of the patch that it falls on; kNone: it lies between
    float s;     ///< along the line
    uint control, end_control; ///< as in LinePlace
};

/// Of sample i_j_edge.xy of edge i_j_edge.z, not a corner: the one rule that neighbours agree by.
EdgeSample snap_edge_sample(const uint packed_levels, const uvec3 i_j_edge, const bool is_reversed) {
    uint level = packed_patch_level(packed_levels);
    uint n = 1u << level;
    uint edge = i_j_edge.z;
    uint k = move_line_sample(find_line_sample(i_j_edge.x, i_j_edge.y, level, edge, is_reversed),
                              level - packed_edge_level(packed_levels, edge));
    uint corner = k != 0u && k != n ? kNone : (k == 0u) == is_reversed ? (edge + 1u) & 3u : edge;
    uint control = 4u + 2u * edge;
    return EdgeSample(corner, float(k) * (1.0 / float(n)), control + (is_reversed ? 1u : 0u),
                      control + (is_reversed ? 0u : 1u));
}

/// A sample of edge i_j_edge.z, not a corner, before snapping.
LinePlace find_edge_place(const SurfaceData s, const uvec4 quad, const uint patch_index, const uint packed_levels,
                          const uvec3 i_j_edge) {
    EdgeLine line = find_edge_line(s, quad, patch_index, i_j_edge.z);
    EdgeSample moved = snap_edge_sample(packed_levels, i_j_edge, line.is_reversed);
    if (moved.corner != kNone) return find_corner(s, quad, moved.corner);
    return LinePlace(line.first, line.second, moved.s, moved.control, moved.end_control, kMipEdges + i_j_edge.z);
}

bool is_on_boundary(const uint packed_levels, const uint i, const uint j) {
    uint n = 1u << packed_patch_level(packed_levels);
    return i == 0u || j == 0u || i == n || j == n;
}

#endif
