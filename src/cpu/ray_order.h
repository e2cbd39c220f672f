// Rays in an order in which neighbours go about the same way, so that more of them travel in packets.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cpu/tracer.h"

namespace relief::cpu {

/// Memory of one thread. All but `places` may have more members than there are rays.
struct RayOrder {
    std::vector<uint16_t> cells;  ///< of directions, by LOD bias
    std::vector<uint32_t> places; ///< of the rays in the list that was given
    std::vector<TraceRay> rays;   ///< in order
    std::vector<TraceHit> hits;   ///< likewise
    std::vector<uint8_t> occluded;
};

/// As Tracer::closest_hits, of rays most of which go another way than their neighbours. order.places lists
/// all of them afterwards as they were traced. Thread safe.
void closest_scattered_hits(const Tracer& tracer, std::span<const TraceRay> rays, std::span<TraceHit> hits,
                            int depth, RayOrder& order);
/// The same of Tracer::any_hits.
void any_scattered_hits(const Tracer& tracer, std::span<const TraceRay> rays, std::span<uint8_t> occluded,
                        int depth, RayOrder& order);

} // namespace relief::cpu
