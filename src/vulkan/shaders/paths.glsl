// Path state for the path tracing kernels.
#ifndef RELIEF_PATHS_GLSL
#define RELIEF_PATHS_GLSL

#include "vulkan/shaders/scene.glsl"
#include "formulas/sobol.h"
#include "formulas/warp.h"
#include "formulas/picture_plane.h"
#include "formulas/camera.h"
#include "formulas/bounce_lod.h"
#include "vulkan/shaders/ggx_table.glsl"
#include "formulas/ggx_albedo.h"
#include "formulas/bsdf.h"
#include "formulas/layered_bsdf.h"
#include "formulas/lobe_shares.h"
#include "formulas/light.h"
#include "formulas/environment.h"
#include "formulas/path.h"
#include "formulas/surface_point.h"
#include "vulkan/layout/device_rays.h"
#include "formulas/pixel_order.h"
#include "vulkan/layout/device_paths.h"

layout(scalar, set = 0, binding = kBindMaterials) readonly buffer Materials { MaterialData materials[]; };
layout(scalar, set = 0, binding = kBindRays) buffer Rays { RayData rays[]; };
layout(scalar, set = 0, binding = kBindHits) buffer Hits { HitData hits[]; };
layout(scalar, set = 0, binding = kBindCounters) buffer Counters { CounterData counters; };
layout(scalar, set = 0, binding = kBindPaths) buffer Paths { PathData paths[]; };
layout(scalar, set = 0, binding = kBindPoints) buffer Points { SurfacePointData points[]; };
layout(scalar, set = 0, binding = kBindFilm) buffer FilmSums { FilmSumsData film[]; };
layout(scalar, set = 0, binding = kBindPathList) buffer PathList { uint path_list[]; };
layout(scalar, set = 0, binding = kBindNextPathList) buffer NextPathList { uint next_path_list[]; };
layout(scalar, set = 0, binding = kBindShadowList) buffer ShadowList { uint shadow_list[]; };

bool is_hit(HitData hit) { return hit.instance != kNone; }

layout(constant_id = kLayersConstant) const uint kHasLayers = 0;
layout(constant_id = kLightTreeConstant) const uint kHasLightTree = 0;
layout(constant_id = kLightLinksConstant) const uint kHasLightLinks = 0;
layout(constant_id = kLightTexturesConstant) const uint kHasLightTextures = 0;

/// The BSDF for one outgoing direction, in a local frame: one of the two.
struct Scattering {
    Basis basis;
    vec3 wo_local;
    bool has_layers; ///< false wherever kHasLayers is 0, which removes what needs them
    Bsdf bsdf;
    LayeredBsdf layered;
};

Scattering make_scattering(SurfacePointData point, MaterialData material, vec3 wo) {
    Scattering result;
    result.basis = make_basis(point.bent_normal);
    result.wo_local = lift_viewer(to_local(result.basis, wo));
    result.has_layers = kHasLayers != 0u && material.has_layers != 0u;
    if (result.has_layers) {
        LayeredSurface surface = {point.base_color, point.roughness, material.layers};
        surface.layers.metallic = point.metallic;
        result.layered = make_layered_bsdf(surface, kLayerTable, result.wo_local.z);
        return result;
    }
    BsdfParameters parameters = {point.base_color, point.roughness, point.metallic, material.ior};
    result.bsdf = make_bsdf(parameters, result.wo_local.z);
    return result;
}

BsdfValue evaluate_scattering(Scattering scattering, vec3 wi) {
    if (scattering.has_layers) return evaluate_layered_bsdf(scattering.layered, kLayerTable, scattering.wo_local, wi);
    return evaluate_bsdf(scattering.bsdf, scattering.wo_local, wi);
}

/// The diffuse part of it.
vec3 evaluate_diffuse_scattering(Scattering scattering, vec3 wi) {
    if (scattering.has_layers) return evaluate_layered_diffuse(scattering.layered, kLayerTable, scattering.wo_local, wi);
    return evaluate_diffuse(scattering.bsdf, scattering.wo_local, wi);
}

BsdfSample sample_scattering(Scattering scattering, float u_lobe, vec2 u) {
    if (scattering.has_layers)
        return sample_layered_bsdf(scattering.layered, kLayerTable, scattering.wo_local, u_lobe, u);
    return sample_bsdf(scattering.bsdf, scattering.wo_local, u_lobe, u);
}

#endif
