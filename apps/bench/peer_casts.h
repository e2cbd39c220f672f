// Warm rays: trees built, caches full, the same rays repeatedly, after comparing the hits.
#pragma once

#include <vector>

#include "bench/peer_rays.h"
#include "bench/peer_scene.h"
#include "common/report.h"

namespace relief::bench {

struct PeerCasts {
    Value agreements; ///< a list of describe_agreement
    Value casts;      ///< a list of {rays, kind, count, hits, ways: [{program, way, call,
                      ///< threads, isa, seconds, rays_per_s}]}
    Value memory;     ///< bytes per patch and per micro-quad of both
};

/// Compares all hits first. Throws Error{failed} if they differ too much.
PeerCasts measure_casts(const PeerScene& scene, const TracerProbe& probe, const std::vector<PeerRays>& sets);

} // namespace relief::bench
