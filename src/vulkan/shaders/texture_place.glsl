// Where hits are on the textures of their materials.
#ifndef RELIEF_TEXTURE_PLACE_GLSL
#define RELIEF_TEXTURE_PLACE_GLSL

#include "vulkan/shaders/scene.glsl"
#include "formulas/surface_point.h"

layout(constant_id = kUvSetsConstant) const uint kHasUvSets = 0;

struct TexturePlace {
    uint surface;
    uint patch_index;
    vec2 at; ///< on the patch
    vec2 uv; ///< in the mesh's own set
};

vec2 blend_corner_uvs(const SurfaceData s, vec2 uv[4], const vec2 at) {
    bool is_bilinear = s.map != kNone || s.has_bilinear_uvs != 0u;
    return is_bilinear ? blend_patch_uv(uv[0], uv[1], uv[2], uv[3], at)
                       : blend_polygon_uv(uv[0], uv[1], uv[2], uv[3], at);
}

/// `at`: on the patch.
vec2 interpolate_uv(const SurfaceData s, const uvec4 quad, const vec2 at) {
    if (s.first_uv == kNone) return vec2(0.0);
    vec2 uv[4] = {load_uv(s, quad.x), load_uv(s, quad.y), load_uv(s, quad.z), load_uv(s, quad.w)};
    return blend_corner_uvs(s, uv, at);
}

/// In the set that a texture names, InputTextureData::uv_set.
vec2 find_uv(const TexturePlace place, const uint uv_set) {
    if (kHasUvSets == 0u || uv_set == kNone) return place.uv;
    SurfaceData s = surfaces[place.surface];
    if (s.first_uv_set == kNone) return place.uv;
    uint first = texelFetch(override_bits, int(s.first_uv_set + uv_set)).x;
    if (first == kNone) return place.uv;
    vec2 uv[4];
    for (uint k = 0u; k < 4u; ++k) uv[k] = texelFetch(uvs, int(first + 4u * place.patch_index + k)).xy;
    return blend_corner_uvs(s, uv, place.at);
}

#endif
