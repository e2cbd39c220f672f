#include "cpu/ordered_hits.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <tuple>
#include <vector>

#include "base/check.h"
#include "base/parallel.h"
#include "formulas/levels.h"
#include "formulas/object_ray.h"

namespace relief::cpu {

namespace {

constexpr size_t kSliceSize = 1024;

/// Pairs by patch; those of one patch at one set of levels are neighbours.
struct OrderedPairs {
    std::vector<PatchEntry> entries;
    std::vector<size_t> begins; ///< of each group, and the end of the last
};

using Slices = std::vector<std::vector<PatchEntry>>;

Slices list_pairs(const OrderedCast& cast, std::span<TraceHit> hits) {
    Slices slices((cast.rays.size() + kSliceSize - 1) / kSliceSize);
    parallel_for("list_patches", cast.rays.size(), kSliceSize, [&](size_t begin, size_t end) {
        std::vector<PatchEntry>& slice = slices[begin / kSliceSize];
        cast.run(end - begin, [&](const SceneView& scene, TraceContext& context) {
            for (size_t k = begin; k < end; ++k) {
                const size_t count = slice.size();
                cast.kernels.list_patches(scene, context, cast.rays[k], uint32_t(k), hits[k], slice);
                if (cast.query == OrderedQuery::any && hits[k].is_hit()) slice.resize(count);
            }
        });
    });
    return slices;
}

/// A counting sort by the number of the patch among those of all surfaces.
OrderedPairs order_pairs(const SceneView& scene, Slices slices) {
    std::vector<size_t> first_patch(1, 0);
    for (uint32_t instance = 0; instance < scene.instance_count; ++instance) {
        const uint32_t surface = scene.instances[instance].surface;
        if (surface + 2 > first_patch.size()) first_patch.resize(surface + 2);
        first_patch[surface + 1] = scene.surfaces[surface].quads.size();
    }
    for (size_t k = 1; k < first_patch.size(); ++k) first_patch[k] += first_patch[k - 1];
    const auto number = [&](const PatchEntry& e) {
        return first_patch[scene.instances[e.instance].surface] + e.patch;
    };
    std::vector<size_t> ends(first_patch.back() + 1);
    for (const std::vector<PatchEntry>& slice : slices)
        for (const PatchEntry& entry : slice) ++ends[number(entry) + 1];
    OrderedPairs pairs;
    pairs.begins.push_back(0);
    for (size_t k = 1; k < ends.size(); ++k) {
        if (ends[k] > 0) pairs.begins.push_back(pairs.begins.back() + ends[k]);
        ends[k] += ends[k - 1];
    }
    pairs.entries.resize(ends.back());
    for (std::vector<PatchEntry>& slice : slices) {
        for (const PatchEntry& entry : slice) pairs.entries[ends[number(entry)]++] = entry;
        slice = {};
    }
    return pairs;
}

/// Instances of one surface may have different levels, and each of these its own trees.
size_t count_bytes(const SceneView& scene, const OrderedPairs& pairs) {
    size_t bytes = 0;
    for (size_t group = 0; group + 1 < pairs.begins.size(); ++group) {
        const PatchEntry& first = pairs.entries[pairs.begins[group]];
        bytes += count_tree_bytes(
            scalar::packed_patch_level(scene.instances[first.instance].levels->packed_at(first.patch)));
    }
    return bytes;
}

/// Several workers meet patches at once: ties in distance are broken independently of their order.
class RayLocks {
  public:
    explicit RayLocks(size_t count) : is_taken_(count) {}
    void lock(size_t ray) {
        while (is_taken_[ray].exchange(1, std::memory_order_acquire)) std::this_thread::yield();
    }
    void unlock(size_t ray) { is_taken_[ray].store(0, std::memory_order_release); }

  private:
    std::vector<std::atomic<uint8_t>> is_taken_;
};

/// One pair; the ray is locked.
void trace_pair(const OrderedCast& cast, const SceneView& scene, TraceContext& context,
                const PatchEntry& entry, TraceHit& hit) {
    const TraceRay& ray = cast.rays[entry.ray];
    const PrimitiveKernels& primitive = cast.kernels.primitive;
    if (cast.query == OrderedQuery::closest) {
        if (!(entry.entry > hit.t * scalar::kBoxSlack))
            primitive.closest(scene, context, ray, entry.instance, entry.patch, hit);
    } else if (!hit.is_hit() && primitive.any(scene, context, ray, entry.instance, entry.patch, hit)) {
        hit.instance = entry.instance;
    }
}

void trace_group(const OrderedCast& cast, const SceneView& scene, TraceContext& context,
                 std::span<PatchEntry> group, std::span<TraceHit> hits, RayLocks& locks) {
    const auto key = [&](const PatchEntry& e) {
        return std::tuple(scene.instances[e.instance].levels->packed_at(e.patch), e.entry, e.ray);
    };
    std::sort(group.begin(), group.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
    const PatchTreeCache::OwnedTrees scope(*scene.cache, context);
    for (const PatchEntry& entry : group) {
        locks.lock(entry.ray);
        trace_pair(cast, scene, context, entry, hits[entry.ray]);
        locks.unlock(entry.ray);
    }
}

} // namespace

size_t count_tree_bytes(uint32_t level) {
    if (level <= uint32_t(kTileLevel)) return PatchTree::size_bytes(int(level));
    size_t directories = 0;
    for (uint32_t step = 0; step < DirectoryPlace::step_count(level); ++step)
        directories += size_t(DirectoryPlace::side(level, step)) * DirectoryPlace::side(level, step);
    return (PatchTree::size_bytes(kTileLevel) << 2 * (level - kTileLevel)) +
           directories * sizeof(TileDirectory);
}

bool trace_ordered(const OrderedCast& cast, std::span<TraceHit> hits) {
    DCHECK(cast.rays.size() == hits.size() && cast.rays.size() <= kOrderedRays);
    OrderedPairs pairs = order_pairs(cast.scene, list_pairs(cast, hits));
    if (count_bytes(cast.scene, pairs) <= cast.room_bytes) return false;
    RayLocks locks(cast.rays.size());
    parallel_for("ordered_hits", pairs.begins.size() - 1, 1, [&](size_t begin, size_t end) {
        cast.run(0, [&](const SceneView& view, TraceContext& context) {
            for (size_t k = begin; k < end; ++k)
                trace_group(
                    cast, view, context,
                    std::span(pairs.entries).subspan(pairs.begins[k], pairs.begins[k + 1] - pairs.begins[k]),
                    hits, locks);
        });
    });
    return true;
}

} // namespace relief::cpu
