// Checks ray by ray that two programs hit the same surface, as a precondition for comparing times.
#pragma once

#include <string>

#include "bench/embree_scene.h"
#include "bench/peer_rays.h"
#include "common/report.h"

namespace relief::bench {

/// Rays with different results in two programs.
struct Agreement {
    std::string rays, against;
    uint64_t count = 0;             ///< rays compared
    uint64_t hits = 0;              ///< hits of Relief's direct tracing
    uint64_t missed = 0, extra = 0; ///< Relief misses what the other hits, or hits what it misses
    /// Both hit, distances differ by more than 1e-5, relative (short ones: of a tenth of the largest
    /// coordinate of the ray's origin).
    uint64_t depth = 0;
    /// Of these three, rays whose nearer hit lies within 1e-6 (relative to the largest coordinate) of an edge
    /// of its triangle, where rounding decides. For Embree's hits only if it has triangles.
    uint64_t at_edges = 0;
    uint64_t grazing = 0;     ///< of `depth`: both hits within 1e-6 of the nearer one's plane, not at edges
    double largest_depth = 0; ///< relative, of common hits that are neither

    uint64_t differences() const { return missed + extra + depth; }
};

/// Compares Relief's hits with Embree's for the same rays.
Agreement compare_with_embree(const TracerProbe& probe, const EmbreeScene& embree, EmbreeWay way,
                              const PeerRays& set);
/// Compares with Relief's tracing of the same surface, pre-tessellated.
Agreement compare_with_tessellated(const TracerProbe& probe, const TracerProbe& tessellated,
                                   const PeerRays& set);

/// Throws Error{failed} if too many rays differ away from edges: more than eight, and more than one in a
/// thousand hits.
void require_agreement(const std::string& scene, const Agreement& agreement);

Value describe_agreement(const Agreement& agreement);

} // namespace relief::bench
