// Where a point of a surface is on the textures of its material.
#pragma once

#include "cpu/tracer.h"
#include "formulas/surface_point.h"
#include "prepare/prepared_scene.h"

namespace relief::cpu {

/// Uv at (u, v) of a patch whose corners have these.
inline Vec2f blend_corner_uvs(const Surface& surface, const std::array<Vec2f, 4>& c, const Vec2f& at) {
    return surface.has_displacement || surface.has_bilinear_uvs
               ? scalar::blend_patch_uv(c[0], c[1], c[2], c[3], at)
               : scalar::blend_polygon_uv(c[0], c[1], c[2], c[3], at);
}

struct TexturePlace {
    const Surface& surface;
    uint32_t patch;
    Vec2f at; ///< (u, v) on the patch
    Vec2f uv; ///< in the mesh's own set

    /// In the set that a texture names.
    Vec2f find_uv(int uv_set) const {
        const PatchUvs* further = surface.find_further_uvs(uv_set);
        return further ? blend_corner_uvs(surface, further->corners[patch], at) : uv;
    }
};

/// `uv`: of the hit, in the mesh's own set.
inline TexturePlace place_hit(const PreparedScene& scene, const TraceHit& hit, const Vec2f& uv) {
    return {scene.surfaces[scene.instances[hit.instance].surface], hit.patch, {hit.u, hit.v}, uv};
}

} // namespace relief::cpu
