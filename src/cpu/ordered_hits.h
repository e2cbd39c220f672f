// Rays in the order of the patches that they may meet, so that each patch tree is built once for all of them:
// pairs, sort, build, trace (Harada 2015, section 1.4). For batches whose trees do not fit into the cache.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "cpu/traversal/kernels.h"

namespace relief::cpu {

/// Rays traced together: their pairs take some 16 bytes each.
inline constexpr size_t kOrderedRays = size_t(1) << 20;

/// Runs `work` with the context of a worker; `rays` are counted in the statistics.
using RunCast =
    std::function<void(size_t rays, const std::function<void(const SceneView&, TraceContext&)>& work)>;

/// Bytes of all trees of a patch at its levels.
size_t count_tree_bytes(uint32_t level);

/// closest: the hits of Kernels::closest_hits. any: those of rays that Kernels::any_hits calls occluded are
/// hits, and say nothing else.
enum class OrderedQuery { closest, any };

struct OrderedCast {
    const Kernels& kernels;
    const SceneView& scene;
    const RunCast& run;
    OrderedQuery query;
    std::span<const TraceRay> rays; ///< LOD bias 0, at most kOrderedRays
    size_t room_bytes;              ///< for trees
};

/// Hits of the rays, `hits[k]` of `rays[k]`. If the trees of all patches that they may meet have room: false,
/// and `hits` is not to be used. Uses the threads of the scope.
bool trace_ordered(const OrderedCast& cast, std::span<TraceHit> hits);

} // namespace relief::cpu
