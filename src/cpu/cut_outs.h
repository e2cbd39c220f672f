// Surfaces that rays go straight on through: cut-outs, which are met with the probability of their opacity,
// and clear walls, which let a part of the light pass.
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

/// How a ray passes a clear wall: by chance, or always and with less of its light, as rays to lights do.
enum class WallRule { by_chance, by_weight };

/// The paths that rays belong to.
struct CutOutPaths {
    /// A number in [0, 1) for ray k, which has passed `round` surfaces before.
    std::function<float(uint32_t k, uint32_t round)> draw;
    /// Ray k goes on behind the clear wall of hits[k], with `left` of its light.
    std::function<void(uint32_t k, const Vec3f& left)> pass_wall;
    WallRule rule;
};

/// Lets rays k go on behind the surfaces that they pass, until they meet one or nothing: rays[k] and hits[k],
/// which were found as closest_bounce_hits does at `depth`, become those of what they met. Empty
/// `coarse_from`: of camera and shadow rays, which see one surface all the way. Thread safe.
void pass_cut_outs(const Tracer& tracer, std::span<TraceRay> rays, std::span<const float> coarse_from,
                   std::span<TraceHit> hits, int depth, const CutOutPaths& paths, CutOutScratch& scratch);

} // namespace relief::cpu
