// Rays of the kinds that renderers cast, from the hits of a scene's camera: the same for all that are
// compared.
#pragma once

#include <string>
#include <vector>

#include "lab/tracer_probe.h"

namespace relief::bench {

struct PeerRays {
    std::string name; ///< primary, lens, sun, occlusion, diffuse_1 ... diffuse_5
    HitKind kind = HitKind::closest;
    bool is_coherent = false; ///< neighbours go the same way
    std::vector<Ray> rays;
};

inline constexpr int kPeerBounces = 5;

/// primary: the middles of the pixels; lens: the same from places on a lens; sun: from each hit, where its
/// side looks there, to one direction; occlusion and diffuse_1: by the cosine about the geometric normal of
/// each hit, without end; diffuse_k: from the hits of diffuse_{k - 1}. Rays that leave the surface start
/// where the engine's do.
std::vector<PeerRays> make_peer_rays(const TracerProbe& probe, const Camera& camera);

const PeerRays& find_rays(const std::vector<PeerRays>& sets, const std::string& name);

} // namespace relief::bench
