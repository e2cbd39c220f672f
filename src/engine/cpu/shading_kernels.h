// The door to the SIMD kernels of shading: one table of functions for each instruction set that they were
// compiled for.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/cpu/tracer.h"
#include "math/scalar.h"

namespace relief::cpu {

/// Hits on patches of one displaced surface whose first corners share a tile that has a map.
struct PointBatch {
    const PreparedScene& scene;
    PatchSamplesCache& patches;
    const TraceHit* hits;
    const uint32_t* order; ///< numbers of the hits that are meant, and of their points
    size_t count;
    SurfacePoint* points;
};

struct ShadingKernels {
    const char* name;                       ///< as that of the Kernels for the same instruction set
    void (*make_points)(const PointBatch&); ///< as Tracer::make_surface_point
    /// drawn[k] = scalar::sobol_pair(seeds[k], sample_index, pair).
    void (*draw_pairs)(const uint32_t* seeds, size_t count, uint32_t sample_index, uint32_t pair,
                       Vec2f* drawn);
    /// rays[k] as scalar::make_pinhole_ray aims it through positions[k], in pixels.
    void (*aim_rays)(const scalar::CameraFrame& camera, const Vec2f* positions, size_t count, TraceRay* rays);
};

/// `name`: of an instruction set that this machine has (Kernels::name).
const ShadingKernels& find_shading_kernels(const char* name);

} // namespace relief::cpu
