// Where hits are on the textures of their materials.
#ifndef RELIEF_TEXTURE_PLACE_GLSL
#define RELIEF_TEXTURE_PLACE_GLSL

#include "vulkan/shaders/scene.glsl"
#include "formulas/surface_point.h"

/// `at`: on the patch.
vec2 interpolate_uv(SurfaceData s, uvec4 quad, vec2 at) {
    if (s.first_uv == kNone) return vec2(0.0);
    bool is_bilinear = s.map != kNone || s.has_bilinear_uvs != 0u;
    vec2 uv[4] = {load_uv(s, quad.x), load_uv(s, quad.y), load_uv(s, quad.z), load_uv(s, quad.w)};
    return is_bilinear ? blend_patch_uv(uv[0], uv[1], uv[2], uv[3], at)
                       : blend_polygon_uv(uv[0], uv[1], uv[2], uv[3], at);
}

#endif
