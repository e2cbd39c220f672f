// Cut-outs: surfaces that are met with the probability of their opacity, and let rays through else.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "cpu/bounce_rays.h"

namespace relief::cpu {

/// Memory of one thread for rays that go on behind cut-outs.
struct CutOutScratch {
    std::vector<uint32_t> indices; ///< of the rays that go on
    std::vector<TraceRay> rays;
    std::vector<float> coarse_from;
    std::vector<TraceHit> hits;
    std::vector<SurfacePoint> points;
    BounceScratch bounces;
    PointScratch patches;
};

/// A number in [0, 1) for ray k, which has passed `round` cut-outs before.
using CutOutDraw = std::function<float(uint32_t k, uint32_t round)>;

/// Lets rays k go on behind the cut-outs that they pass, until they meet a surface or nothing: rays[k] and
/// hits[k], which were found as closest_bounce_hits does at `depth`, become those of what they met. Empty
/// `coarse_from`: of camera and shadow rays, which see one surface all the way. Thread safe.
void pass_cut_outs(const Tracer& tracer, std::span<TraceRay> rays, std::span<const float> coarse_from,
                   std::span<TraceHit> hits, int depth, const CutOutDraw& draw, CutOutScratch& scratch);

} // namespace relief::cpu
