// Walks of lab/walks/walks.h from the root.
#pragma once

#include <cstdint>

#include "lab/walks/walks.h"

namespace relief {

namespace scalar {

inline uint make_root_key(uint) { return 1u; }
inline HeapKey make_root_key(HeapKey) { return {1u, 0u}; }

} // namespace scalar

/// Calls `leaf(primitive_id, ray)` for every primitive whose box the ray may meet before ray.t_max (in a
/// kd-tree perhaps several times); the leaf shortens ray.t_max to its hits. Where hits tie, the leaf decides.
/// `counts`: WalkCounts to add to, or NoCounts.
template <TraversalKind kTraversal, class View, class Leaf, class Counts = NoCounts>
void closest_hit(const View& view, BoxRay& ray, Leaf&& leaf, Counts&& counts = {}) {
    auto start = scalar::make_root_key(typename View::Key{});
    closest_hit_from<kTraversal>(view, start, ray, leaf, counts);
}

/// Whether `leaf(primitive_id, ray)` was true for any primitive; stops at the first.
template <TraversalKind kTraversal, class View, class Leaf, class Counts = NoCounts>
bool any_hit(const View& view, const BoxRay& ray, Leaf&& leaf, Counts&& counts = {}) {
    auto start = scalar::make_root_key(typename View::Key{});
    return any_hit_from<kTraversal>(view, start, ray, leaf, counts);
}

} // namespace relief
