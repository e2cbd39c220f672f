// Bounce rays in two parts: near the vertex that they leave they see its surface, beyond a coarser one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cpu/ray_order.h"
#include "cpu/tracer.h"
#include "formulas/bounce_lod.h"

namespace relief::cpu {

/// Memory of one thread for closest_bounce_hits.
struct BounceScratch {
    std::vector<uint32_t> indices; ///< of the rays that go on
    std::vector<TraceRay> rays;
    std::vector<TraceHit> hits;
    std::vector<SurfacePoint> points;
    RayOrder order;
};

/// As Tracer::closest_hits at `depth`, where ray k sees M_(lod_bias) up to coarse_from[k] and M_(kBounceBias)
/// beyond. Where the far part begins between the two surfaces it would meet the coarse one from within: such
/// rays see the fine one all the way. Rays come back with the LOD bias of what they met. Thread safe.
void closest_bounce_hits(const Tracer& tracer, std::span<TraceRay> rays, std::span<const float> coarse_from,
                         std::span<TraceHit> hits, int depth, BounceScratch& scratch, PointScratch& points);

} // namespace relief::cpu
