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

/// Nearest hits as Kernels::closest_hits finds them, of rays with an LOD bias of 0. If the trees of all
/// patches that the rays may meet fit into `room_bytes`: false, and `hits` is not to be used. Uses the
/// threads of the scope.
bool trace_ordered(const Kernels& kernels, const SceneView& scene, const RunCast& run,
                   std::span<const TraceRay> rays, std::span<TraceHit> hits, size_t room_bytes);

} // namespace relief::cpu
