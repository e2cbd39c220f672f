// SIMD kernels of shading: one dispatch table an instruction set that was compiled in.
#pragma once

#include <cstddef>
#include <cstdint>

#include "cpu/shading/environment_light.h"
#include "cpu/tracer.h"
#include "formulas/basis.h"
#include "formulas/camera.h"
#include "formulas/glass_parameters.h"
#include "formulas/layer_parameters.h"

namespace relief::cpu {

/// Hits on patches of one displaced surface with a common tile that has a map, or on plain polygons of one.
struct PointBatch {
    const PreparedScene& scene;
    PatchSamplesCache& patches;
    const TraceHit* hits;
    const uint32_t* order; ///< numbers of the hits that are meant, and of their points
    size_t count;
    SurfacePoint* points;
};

/// Layers of all materials of a scene that have some; they outlive whatever reads them.
struct LayerView {
    const scalar::LayerParameters* records = nullptr;
    const Vec2f* entries = nullptr; ///< the albedo table
    uint32_t entry_count = 0;
};

/// Hits that paths of a wave have come to.
struct VertexBatch {
    size_t count; ///< 1 to 16
    const SurfacePoint* points;
    const TraceRay* rays;    ///< that came there
    const Vec2f* pick_pairs; ///< random numbers, y picks the lobe; null: no path goes on
    const Vec2f* bsdf_pairs;
    LayerView layers;                               ///< read where VertexLanes::has_layers says so
    const scalar::GlassParameters* glass = nullptr; ///< and has_glass
    bool wants_diffuse_shares = false;
};

/// Sixteen vertices, a lane each. Masks have a bit a lane.
struct VertexLanes {
    // Given. Lanes beyond the batch may hold anything; with metallic 0 and ior 1 they cost nothing.
    alignas(64) float base_color[3][16], roughness[16], metallic[16], ior[16];
    alignas(64) float light_direction[3][16], light_pdf[16]; ///< density 0: none was drawn, any direction
    alignas(64) float light_lift[16];                        ///< of find_light_lift()
    uint32_t has_layers;             ///< bits of lanes with layers; metallic 0 and ior 1 save work in them
    alignas(64) uint32_t layers[16]; ///< of such a lane, its record
    alignas(64) float layered_metallic[16]; ///< of such a lane, in place of the record's
    alignas(64) float tangent[3][16];       ///< of a lane whose layers or glass are anisotropic, world space
    uint32_t has_glass;             ///< bits of lanes that are glass; metallic 0 and ior 1 save work in them
    alignas(64) uint32_t glass[16]; ///< of such a lane, its place in VertexBatch::glass
    // Found. Normals are on the viewer's side; origins are moved off the surface.
    alignas(64) float geometric_normal[3][16], shading_normal[3][16];
    alignas(64) float light_reflected[3][16]; ///< BSDF times cosine
    alignas(64) float light_bsdf_pdf[16];     ///< with which the BSDF would have drawn that direction
    alignas(64) float shadow_origin[3][16];
    alignas(64) float bounce_direction[3][16], bounce_origin[3][16];
    alignas(64) float bounce_weight[3][16], bounce_pdf[16];
    uint32_t needs_shadow_ray; ///< some of the light could arrive
    uint32_t has_bounce;       ///< a ray leaves the surface
    /// Where they are asked for: of the light reflected and of the bounce weight, the part that is diffuse.
    alignas(64) float light_diffuse[3][16], bounce_diffuse[3][16];
};

inline Vec3f get_lane(const float (&vectors)[3][16], size_t lane) {
    return {vectors[0][lane], vectors[1][lane], vectors[2][lane]};
}

inline void set_lane(const Vec3f& v, size_t lane, float (&vectors)[3][16]) {
    vectors[0][lane] = v.x, vectors[1][lane] = v.y, vectors[2][lane] = v.z;
}

/// Samples of pixels, by seeds of the pixels and numbers of the samples.
struct SampleList {
    const uint32_t *seeds, *samples;
    size_t count;
};

struct ShadingKernels {
    const char* name;                               ///< as that of the Kernels for the same instruction set
    void (*make_points)(const PointBatch&);         ///< as Tracer::make_surface_point, on a displaced surface
    void (*make_polygon_points)(const PointBatch&); ///< the same on one that is not
    /// drawn[k] = scalar::sobol_pair(seeds[k], samples[k], pair).
    void (*sample_2d)(const SampleList&, uint32_t pair, Vec2f* drawn);
    /// What the vertices of a batch scatter (formulas/bsdf.h, layered_bsdf.h, glass_bsdf.h).
    void (*reflect)(const VertexBatch&, VertexLanes&);
    /// As the functions of EnvironmentLight for one direction, place or pair.
    void (*look_up_environment)(const EnvironmentTables&, const Vec3f* directions, size_t count,
                                EnvironmentLookup* found);
    void (*fetch_environment)(const EnvironmentTables&, const Vec2f* positions, size_t count,
                              Vec3f* radiances);
    void (*draw_directions)(const EnvironmentTables&, const Vec2f* u, size_t count, DirectionSample* drawn);
    /// Unit vectors as scalar::draw_sun draws them from a cone of that height, above 0, about axes.n.
    void (*draw_cone)(const scalar::Basis& axes, float height, const Vec2f* u, size_t count,
                      Vec3f* directions);
    /// As fetch_texture(texture, uvs[k]), bilinear and repeated; `uvs` are finite.
    void (*fetch_texture)(const Texture& texture, const Vec2f* uvs, size_t count, Vec3f* colors);
    /// rays[k] as scalar::make_pinhole_ray aims it through positions[k], in pixels.
    void (*aim_rays)(const scalar::CameraFrame& camera, const Vec2f* positions, size_t count, TraceRay* rays);
};

/// `name`: of an instruction set that this machine has (Kernels::name).
const ShadingKernels& find_shading_kernels(const char* name);

} // namespace relief::cpu
