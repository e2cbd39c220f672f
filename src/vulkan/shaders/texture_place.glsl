// Where hits are on the textures of their materials.
#ifndef RELIEF_TEXTURE_PLACE_GLSL
#define RELIEF_TEXTURE_PLACE_GLSL

#include "vulkan/shaders/patch_evaluation.glsl"
#include "formulas/surface_point.h"

/// `at`: on the patch.
vec2 interpolate_uv(SurfaceData s, PatchCorners c, vec2 at) {
    if (s.first_uv == kNone) return vec2(0.0);
    bool is_bilinear = s.map != kNone || s.has_bilinear_uvs != 0u;
    return is_bilinear ? blend_patch_uv(c.corner[0].uv, c.corner[1].uv, c.corner[2].uv, c.corner[3].uv, at)
                       : blend_polygon_uv(c.corner[0].uv, c.corner[1].uv, c.corner[2].uv, c.corner[3].uv, at);
}

#endif
