#include "cpu/bounce_rays.h"

#include "base/check.h"

namespace relief::cpu {

namespace {

/// Traces the part beyond `coarse_from` of the rays that scratch.indices lists, at an LOD bias each.
void trace_far(const Tracer& tracer, std::span<const TraceRay> rays, std::span<const float> coarse_from,
               int depth, uint32_t lod_bias, BounceScratch& scratch) {
    scratch.rays.clear();
    for (const uint32_t k : scratch.indices) {
        TraceRay ray = rays[k];
        ray.t_min = coarse_from[k], ray.t_max = kInfinity, ray.lod_bias = lod_bias;
        scratch.rays.push_back(ray);
    }
    scratch.hits.resize(scratch.rays.size());
    tracer.continued_hits(scratch.rays, scratch.hits, depth);
}

/// Hits of the far parts; scratch.indices becomes those that met a surface from within.
void take_outer_hits(const Tracer& tracer, std::span<TraceRay> rays, std::span<TraceHit> hits,
                     BounceScratch& scratch, PointScratch& points) {
    size_t met = 0;
    for (size_t n = 0; n < scratch.indices.size(); ++n)
        if (scratch.hits[n].is_hit())
            scratch.indices[met] = scratch.indices[n], scratch.hits[met] = scratch.hits[n], ++met;
    scratch.indices.resize(met), scratch.hits.resize(met), scratch.points.resize(met);
    tracer.make_surface_points(scratch.hits, scratch.points, points);
    size_t inner = 0;
    for (size_t n = 0; n < met; ++n) {
        const uint32_t k = scratch.indices[n];
        hits[k] = scratch.hits[n], rays[k].lod_bias = scalar::kBounceBias;
        scratch.indices[inner] = k;
        inner += dot(scratch.points[n].geometric_normal, rays[k].direction) > 0 ? 1 : 0;
    }
    scratch.indices.resize(inner);
}

} // namespace

void closest_bounce_hits(const Tracer& tracer, std::span<TraceRay> rays, std::span<const float> coarse_from,
                         std::span<TraceHit> hits, int depth, BounceScratch& scratch, PointScratch& points) {
    DCHECK(coarse_from.size() == rays.size() && hits.size() == rays.size());
    for (size_t k = 0; k < rays.size(); ++k) rays[k].t_max = coarse_from[k];
    closest_scattered_hits(tracer, rays, hits, depth, scratch.order);
    scratch.indices.clear();
    for (const uint32_t k : scratch.order.places)
        if (!hits[k].is_hit() && coarse_from[k] < kInfinity) scratch.indices.push_back(k);
    if (scratch.indices.empty()) return;
    trace_far(tracer, rays, coarse_from, depth, scalar::kBounceBias, scratch);
    take_outer_hits(tracer, rays, hits, scratch, points);
    if (scratch.indices.empty()) return;
    trace_far(tracer, rays, coarse_from, depth, 0, scratch);
    for (size_t n = 0; n < scratch.indices.size(); ++n) {
        const uint32_t k = scratch.indices[n];
        hits[k] = scratch.hits[n], rays[k].lod_bias = 0;
    }
}

} // namespace relief::cpu
