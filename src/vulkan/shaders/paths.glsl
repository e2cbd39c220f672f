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
#include "formulas/facets.h"
#include "formulas/bsdf.h"
#include "formulas/layered_bsdf.h"
#include "formulas/light_kinds.h"
#include "formulas/lobe_shares.h"
#include "formulas/glass.h"
#include "formulas/glass_bsdf.h"
#include "formulas/glass_vertex.h"
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
layout(scalar, set = 0, binding = kBindPoints) buffer PointNumbers { InputNumbers point_numbers[]; };
layout(scalar, set = 0, binding = kBindPoints) buffer PointTangents { float point_tangents[]; };
layout(scalar, set = 0, binding = kBindFilm) buffer FilmSums { FilmSumsData film[]; };
layout(scalar, set = 0, binding = kBindPathList) buffer PathList { uint path_list[]; };
layout(scalar, set = 0, binding = kBindNextPathList) buffer NextPathList { uint next_path_list[]; };
layout(scalar, set = 0, binding = kBindShadowList) buffer ShadowList { uint shadow_list[]; };

bool is_hit(const HitData hit) { return hit.instance != kNone; }

layout(constant_id = kLayersConstant) const uint kHasLayers = 0;
layout(constant_id = kLightTreeConstant) const uint kHasLightTree = 0;
layout(constant_id = kLightLinksConstant) const uint kHasLightLinks = 0;
layout(constant_id = kLightTexturesConstant) const uint kHasLightTextures = 0;
layout(constant_id = kGlassConstant) const uint kHasGlass = 0;
layout(constant_id = kAnisotropyConstant) const uint kHasAnisotropy = 0;

layout(constant_id = kShadowCatchersConstant) const uint kHasShadowCatchers = 0;

/// Whether what a ray has met after `depth` bounces is a shadow catcher that the camera sees.
bool is_catcher(const HitData hit, const uint depth) {
    return kHasShadowCatchers != 0u && depth == 0u && (instances[hit.instance].levels & kShadowCatcher) != 0u;
}

/// What the textures of a path's material made of its numbers, if it has some; behind all points.
uint find_point_numbers(const uint capacity, const uint path_index) {
    return capacity * kSurfacePointWords / kInputWords + 1u + path_index;
}

/// First word of the tangent at a path's point, if its material is anisotropic; behind all of these.
uint find_point_tangent(const uint capacity, const uint path_index) {
    uint first = kHasVertexNumbers != 0u ? find_point_numbers(capacity, capacity) * kInputWords
                                         : capacity * kSurfacePointWords;
    return first + 3u * path_index;
}

/// Without a trace of anisotropy where there is none.
MaterialData load_material_numbers(const uint index) {
    MaterialData material = materials[index];
    if (kHasAnisotropy != 0u) return material;
    material.layers.specular_anisotropy = 0.0;
    material.layers.coat_anisotropy = 0.0;
    material.layers.azimuth_scale = 0.0;
    material.glass.anisotropy = 0.0;
    return material;
}

/// Of load_material_numbers().
bool is_anisotropic(const MaterialData material) {
    return (material.has_layers != 0u && material.layers.azimuth_scale > 0.0) ||
           (material.has_glass != 0u && material.glass.anisotropy > 0.0);
}

/// A material at a vertex.
struct VertexMaterial {
    MaterialData numbers;
    LayerTable table; ///< of layers
    vec3 tangent;     ///< of anisotropic ones
};

vec3 load_point_tangent(const uint capacity, const uint path_index) {
    uint first = find_point_tangent(capacity, path_index);
    return vec3(point_tangents[first], point_tangents[first + 1u], point_tangents[first + 2u]);
}

layout(scalar, set = 0, binding = kBindMaterials) readonly buffer VertexInputs { MaterialInputData vertex_inputs[]; };

VertexMaterial load_vertex_material(const uint index, const uint capacity, const uint path_index) {
    VertexMaterial material;
    material.numbers = load_material_numbers(index);
    material.table = make_layer_table(kGridTable);
    material.tangent = vec3(0.0);
    if (kHasAnisotropy != 0u && is_anisotropic(material.numbers))
        material.tangent = load_point_tangent(capacity, path_index);
    if (kHasVertexNumbers == 0u || material.numbers.has_vertex_numbers == 0u) return material;
    MaterialInputData inputs = vertex_inputs[material.numbers.inputs];
    InputNumbers textured = point_numbers[find_point_numbers(capacity, path_index)];
    material.numbers.emission = get_input_color(textured, kInputEmission);
    material.numbers.glass = set_glass_inputs(material.numbers.glass, textured, inputs.constants);
    if (kHasLayers == 0u || material.numbers.has_layers == 0u) return material;
    LayerParameters layers = set_layer_inputs(material.numbers.layers, textured, inputs.constants);
    material.table.is_block = true;
    material.table.place = place_layers(inputs.grid, layers.first_entry, textured);
    if (kHasAnisotropy == 0u) material.table.place.azimuth_count = 1u;
    uint average = find_block_average(material.table.place.azimuth_count);
    layers.fuzz_scale = read_layer_entry(material.table, average + 1u).y;
    layers.first_entry = 0u;
    layers.row_scale = 0.0;
    material.numbers.layers = layers;
    return material;
}

/// Shadow catchers are white and diffuse, so that nothing but light and its cosine counts.
VertexMaterial load_lit_material(const uint path_index, const HitData hit, const uint capacity, const uint depth) {
    uint index = instances[hit.instance].material;
    if (!is_catcher(hit, depth)) return load_vertex_material(index, capacity, path_index);
    VertexMaterial white;
    white.numbers = load_material_numbers(index);
    white.numbers.emission = vec3(0.0);
    white.numbers.ior = 1.0;
    white.numbers.has_layers = white.numbers.has_glass = 0u;
    white.table = make_layer_table(kGridTable);
    white.tangent = vec3(0.0);
    return white;
}

/// The BSDF for one outgoing direction, in a local frame: one of the three.
struct Scattering {
    Basis basis;
    vec3 wo_local;
    float u_lobe;    ///< a random number
    bool has_layers; ///< false wherever kHasLayers is 0, which removes what needs them
    bool is_glass;   ///< false wherever kHasGlass is 0, likewise
    Bsdf bsdf;
    LayeredBsdf layered;
    LayerTable table;
    GlassBsdf glass;
};

/// Whether a surface may send light on to its other side, besides straight through.
bool is_see_through(const MaterialData material) {
    return kHasGlass != 0u && material.has_glass != 0u && material.glass.kind < kClearWall;
}

/// What a surface that is partly glass is at a vertex; `u` picks.
GlassDraw draw_vertex_glass(const SurfacePointData point, const MaterialData material, const vec3 wo, const float u) {
    return draw_glass(material.glass, point.metallic, abs(dot(point.geometric_normal, wo)), u);
}

/// `u_pick`: a random number in [0, 1), the same for all that is asked of a vertex.
Scattering make_scattering(SurfacePointData point, const VertexMaterial at, const vec3 wo, const float u_pick) {
    MaterialData material = at.numbers;
    Scattering result;
    result.table = at.table;
    result.basis = make_basis(point.bent_normal);
    if (kHasAnisotropy != 0u && is_anisotropic(material))
        result.basis = make_basis_along(point.bent_normal, at.tangent);
    result.wo_local = lift_viewer(to_local(result.basis, wo));
    result.u_lobe = u_pick;
    result.is_glass = false;
    if (kHasGlass != 0u && material.has_glass != 0u) {
        GlassDraw drawn = draw_vertex_glass(point, material, wo, u_pick);
        result.is_glass = drawn.is_glass;
        result.u_lobe = drawn.u;
        point.metallic = drawn.metallic;
    }
    result.has_layers = kHasLayers != 0u && material.has_layers != 0u;
    if (result.is_glass) {
        result.glass = make_glass_bsdf(material.glass, point.roughness, point.is_flipped != 0u);
        return result;
    }
    if (result.has_layers) {
        LayeredSurface surface = {point.base_color, point.roughness, material.layers};
        surface.layers.metallic = point.metallic;
        result.layered = make_layered_bsdf(surface, result.table, result.wo_local);
        return result;
    }
    BsdfParameters parameters = {point.base_color, point.roughness, point.metallic, material.ior};
    result.bsdf = make_bsdf(parameters, result.wo_local.z);
    return result;
}

BsdfValue evaluate_scattering(const Scattering scattering, const vec3 wi) {
    if (scattering.is_glass) return evaluate_glass_bsdf(scattering.glass, scattering.wo_local, wi);
    if (scattering.has_layers) return evaluate_layered_bsdf(scattering.layered, scattering.table, scattering.wo_local, wi);
    return evaluate_bsdf(scattering.bsdf, scattering.wo_local, wi);
}

/// Of it by way of the BSDF, what is diffuse, and the lobe of the rest.
LightShares find_light_shares(const Scattering scattering, const vec3 wi, const vec3 whole) {
    LightShares shares = {vec3(0.0), wi.z < 0.0 ? kLobeTransmission : kLobeSpecular};
    if (scattering.is_glass) return shares;
    vec3 diffuse = scattering.has_layers
                       ? evaluate_layered_diffuse(scattering.layered, scattering.table, scattering.wo_local, wi)
                       : evaluate_diffuse(scattering.bsdf, scattering.wo_local, wi);
    shares.diffuse = find_shares(diffuse, whole);
    return shares;
}

BsdfSample sample_scattering(const Scattering scattering, const vec2 u) {
    float u_lobe = scattering.u_lobe;
    if (scattering.is_glass) return sample_glass_bsdf(scattering.glass, scattering.wo_local, u_lobe, u);
    if (scattering.has_layers)
        return sample_layered_bsdf(scattering.layered, scattering.table, scattering.wo_local, u_lobe, u);
    return sample_bsdf(scattering.bsdf, scattering.wo_local, u_lobe, u);
}

/// Whether light along `direction` is on one side of the surface and of the shading normal; above, of all but
/// glass. `local`: the direction in the frame of the scattering.
bool is_on_one_side(const Scattering scattering, const SurfacePointData point, const vec3 direction, const vec3 local) {
    float height = dot(point.geometric_normal, direction);
    if (!scattering.is_glass) return height > 0.0;
    return (height > 0.0 && local.z > 0.0) || (height < 0.0 && local.z < 0.0);
}

/// The body that a ray leaves a vertex into; path.body lies before the surface.
uint find_next_body(const PathData path, const Scattering scattering, const SurfacePointData point,
                    const uint material_index, const vec3 direction) {
    if (kHasGlass == 0u) return kNone;
    bool is_through = scattering.is_glass && dot(point.geometric_normal, direction) < 0.0;
    if (!is_through || materials[material_index].glass.kind != kSolidGlass) return path.body;
    return point.is_flipped != 0u ? kNone : material_index;
}

#endif
