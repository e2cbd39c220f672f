// Scene access for kernels: tables, texel buffers, and functions that read them.
#ifndef RELIEF_SCENE_GLSL
#define RELIEF_SCENE_GLSL

#include "formulas/lang.h"
#include "formulas/constants.h"
#include "formulas/exact.h"
#include "formulas/levels.h"
#include "formulas/mips.h"
#include "formulas/frame.h"
#include "formulas/texel.h"
#include "formulas/displace.h"
#include "formulas/control_points.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/layout/device_scene.h"

layout(scalar, set = 0, binding = kBindInstances) readonly buffer Instances { InstanceData instances[]; };
layout(scalar, set = 0, binding = kBindSurfaces) readonly buffer Surfaces { SurfaceData surfaces[]; };
layout(scalar, set = 0, binding = kBindMaps) readonly buffer Maps { MapData maps[]; };
layout(scalar, set = 0, binding = kBindTextures) readonly buffer Textures { TextureData textures[]; };
layout(scalar, set = 0, binding = kBindTileRecords) readonly buffer TileRecords { TileRecord tile_records[]; };

layout(set = 0, binding = kBindPositions) uniform samplerBuffer positions;
layout(set = 0, binding = kBindUvs) uniform samplerBuffer uvs;
layout(set = 0, binding = kBindFrames) uniform usamplerBuffer frames;
layout(set = 0, binding = kBindQuads) uniform usamplerBuffer quads;
layout(set = 0, binding = kBindDominants) uniform usamplerBuffer dominants;
layout(set = 0, binding = kBindVertexTiles) uniform usamplerBuffer vertex_tiles;
layout(set = 0, binding = kBindOverrides) uniform usamplerBuffer overrides;
layout(set = 0, binding = kBindOverrideBits) uniform usamplerBuffer override_bits;
layout(set = 0, binding = kBindLevels) uniform usamplerBuffer field_levels;
layout(set = 0, binding = kBindFloatTexels) uniform samplerBuffer float_texels;
layout(set = 0, binding = kBindHalfTexels) uniform samplerBuffer half_texels;

layout(constant_id = kSmoothConstant) const uint kHasSmooth = 0;

#define kInfinity uintBitsToFloat(0x7f800000u)
const uint kNoTile = 0xffffu;

vec3 load_position_at(const uint place) {
    int first = int(3u * place);
    return vec3(texelFetch(positions, first).x, texelFetch(positions, first + 1).x,
                texelFetch(positions, first + 2).x);
}

/// The lowest of the vertices that a vertex has its place with.
uint load_dominant(const SurfaceData s, const uint vertex) {
    return vertex < s.dominant_count ? vertex : texelFetch(dominants, int(s.first_dominant + vertex - s.dominant_count)).x;
}

vec3 load_position(const SurfaceData s, const uint vertex) {
    return load_position_at(s.first_vertex + load_dominant(s, vertex));
}

vec2 load_uv(const SurfaceData s, const uint vertex) { return texelFetch(uvs, int(s.first_uv + vertex)).xy; }

uvec4 load_quad(const SurfaceData s, const uint patch_index) {
    if (s.has_wide_quads != 0u) return texelFetch(quads, int(s.first_quad_texel + patch_index));
    uvec4 pair = texelFetch(quads, int(s.first_quad_texel + (patch_index >> 1u)));
    uvec2 quad = (patch_index & 1u) == 0u ? pair.xy : pair.zw;
    return uvec4(quad.x & 0xffffu, quad.x >> 16u, quad.y & 0xffffu, quad.y >> 16u);
}

bool is_triangle(const uvec4 quad) { return quad.w == quad.z; }

/// Unit normal; not for surfaces without frames.
vec3 load_normal(const SurfaceData s, const uint vertex) {
    return unpack_unit_normal(texelFetch(frames, int(s.first_frame + vertex)).x);
}

uint load_vertex_tile(const SurfaceData s, const uint vertex) {
    if (s.first_vertex_tile == kNone) return 0u;
    uint place = s.first_vertex_tile + vertex;
    return (texelFetch(vertex_tiles, int(place >> 1u)).x >> (16u * (place & 1u))) & 0xffffu;
}

bool is_seam(const SurfaceData s, const uint patch_index, const uint edge) {
    if (s.first_override_word == kNone) return false;
    uint patch_edge = 4u * patch_index + edge;
    uint word = texelFetch(override_bits, int(s.first_override_word + (patch_edge >> 5u))).x;
    return ((word >> (patch_edge & 31u)) & 1u) != 0u;
}

/// Packed mip levels that a patch reads.
uint load_mips(const SurfaceData s, const uint patch_index) {
    return s.first_mip == kNone ? 0u : texelFetch(override_bits, int(s.first_mip + patch_index)).x;
}

/// Packed levels of a patch of an instance, without LOD bias.
uint find_levels(const InstanceData instance, const uint patch_index) {
    uint levels = instance.levels & ~(kManyLevels | kMirrored | kShadowCatcher | kNarrowLevels);
    if ((instance.levels & kManyLevels) == 0u) return levels;
    if ((instance.levels & kNarrowLevels) != 0u) {
        uint pair = texelFetch(field_levels, int(levels + (patch_index >> 1u))).x;
        return widen_levels(pair >> (16u * (patch_index & 1u)));
    }
    return texelFetch(field_levels, int(levels + patch_index)).x;
}

/// Texel (x, y); must lie inside the texture.
vec4 load_texel(const TextureData texture_data, const uint x, const uint y) {
    int place = int(texture_data.first_texel + y * texture_data.width + x);
    return texture_data.is_half != 0u ? texelFetch(half_texels, place) : texelFetch(float_texels, place);
}

vec3 blend_cubic_vectors(const vec3 a, const vec3 b, const vec3 c, const vec3 d, const CubicWeights weights) {
    return vec3(blend_cubic(a.x, b.x, c.x, d.x, weights), blend_cubic(a.y, b.y, c.y, d.y, weights),
                blend_cubic(a.z, b.z, c.z, d.z, weights));
}

vec3 transform_vector(const AffineData a, const vec3 v) {
    return vec3(dot_exact(a.x, v), dot_exact(a.y, v), dot_exact(a.z, v));
}
vec3 transform_point(const AffineData a, const vec3 p) { return add_exact(transform_vector(a, p), a.t); }
/// Not normalised.
vec3 transform_normal(const AffineData inverse, const vec3 n) {
    return inverse.x * n.x + inverse.y * n.y + inverse.z * n.z;
}

#endif
