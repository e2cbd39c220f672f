// Warm rays: trees built, caches full, the same rays over and over; after the hits were compared.
#pragma once

#include <vector>

#include <nlohmann/json.hpp>

#include "bench/peer_rays.h"
#include "bench/peer_scene.h"

namespace relief::bench {

struct PeerCasts {
    nlohmann::ordered_json agreements; ///< a list of describe_agreement
    nlohmann::ordered_json casts;      ///< a list of {rays, kind, count, hits, ways: [{program, way, call,
                                       ///< threads, isa, seconds, rays_per_s}]}
    nlohmann::ordered_json memory;     ///< bytes a patch and a micro-quad of both
};

/// Compares all hits first. Throws Error{failed} where they differ too much.
PeerCasts measure_casts(const PeerScene& scene, const TracerProbe& probe, const std::vector<PeerRays>& sets);

} // namespace relief::bench
