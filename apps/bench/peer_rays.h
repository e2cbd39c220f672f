// Typical kinds of rays from the camera hits of a scene; the same for all compared programs.
#pragma once

#include <string>
#include <vector>

#include "lab/tracer_probe.h"

namespace relief::bench {

struct PeerRays {
    std::string name; ///< primary, lens, sun, occlusion, diffuse_1 ... diffuse_5
    HitKind kind = HitKind::closest;
    bool is_coherent = false; ///< neighbouring rays are coherent
    std::vector<Ray> rays;
};

inline constexpr int kPeerBounces = 5;

/// primary: pixel centres; lens: the same with origins on a lens; sun: from each hit that faces it towards
/// one direction; occlusion and diffuse_1: cosine distributed about the geometric normal of each hit,
/// unbounded; diffuse_k: from the hits of diffuse_{k - 1}. Spawned rays start at the same offset origins as
/// the engine's.
std::vector<PeerRays> make_peer_rays(const TracerProbe& probe, const Camera& camera);

const PeerRays& find_rays(const std::vector<PeerRays>& sets, const std::string& name);

} // namespace relief::bench
