// Whether two programs meet the same surface, ray by ray: before their times may be compared.
#pragma once

#include <string>

#include "bench/embree_scene.h"
#include "bench/peer_rays.h"
#include "common/report.h"

namespace relief::bench {

/// Rays that two programs answer differently.
struct Agreement {
    std::string rays, against;
    uint64_t count = 0;             ///< rays compared
    uint64_t hits = 0;              ///< of Relief's direct tracing
    uint64_t missed = 0, extra = 0; ///< Relief misses what the other hits, or hits what it misses
    /// Both hit, distances differ by more than 1e-5, relative (short ones: of a tenth of the largest
    /// coordinate of the ray's origin).
    uint64_t depth = 0;
    /// Of these three, those whose nearer hit lies within 1e-6 of an edge of its triangle (a share of the
    /// largest coordinate): rounding decides there. Of Embree's hits only where it has triangles.
    uint64_t at_edges = 0;
    uint64_t grazing = 0;     ///< of `depth`: both hits within 1e-6 of the nearer one's plane, not at edges
    double largest_depth = 0; ///< relative, of hits of both that are neither

    uint64_t differences() const { return missed + extra + depth; }
};

/// Relief's hits against Embree's on the same rays.
Agreement compare_with_embree(const TracerProbe& probe, const EmbreeScene& embree, EmbreeWay way,
                              const PeerRays& set);
/// Against Relief's tracing of the same surface as plain triangles made up front.
Agreement compare_with_tessellated(const TracerProbe& probe, const TracerProbe& tessellated,
                                   const PeerRays& set);

/// Throws Error{failed} where so many rays differ other than at edges that the surfaces cannot be the same:
/// more than eight, and more than one in a thousand of those that hit.
void require_agreement(const std::string& scene, const Agreement& agreement);

Value describe_agreement(const Agreement& agreement);

} // namespace relief::bench
