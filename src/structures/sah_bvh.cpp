#include "structures/sah_bvh.h"

#include <array>
#include <numeric>

#include "base/check.h"
#include "base/parallel.h"
#include "relief/error.h"
#include "structures/sah_split.h"

namespace relief {

namespace {

/// Below this depth sets are halved, so that a tree of 2^30 primitives still keeps to kMaxBvhDepth.
constexpr int kMaxSahDepth = 60;
constexpr uint32_t kMaxPrimitiveCount = 1u << 30;
static_assert(kMaxSahDepth + 30 < kMaxBvhDepth);

/// A subtree with fewer primitives is built by one thread.
constexpr uint32_t kParallelCount = 4096;

/// Small sets are swept even by the binned method: exact, and cheaper than clearing the bins.
constexpr uint32_t kSmallCount = 8;

/// A subtree: primitives [begin, end) and the node slots that only it may use. A tree over n primitives has
/// at most 2n - 1 nodes, hence ranges of slots can be handed out before it is known how many leaves there
/// will be, and the layout does not depend on which thread builds what.
struct Subtree {
    uint32_t begin;
    uint32_t end;
    uint32_t root_slot;
    uint32_t free_slot; ///< the root's descendants use free_slot, ..., free_slot + 2 (end - begin) - 3
    int depth;

    uint32_t count() const { return end - begin; }
};

class SahBuild {
  public:
    SahBuild(std::span<const Box> boxes, const SahBvhBuilder::Config& config)
        : boxes_(boxes), config_(config) {}

    Bvh run() {
        const uint32_t count = uint32_t(boxes_.size());
        bvh_.primitive_ids.resize(count);
        std::iota(bvh_.primitive_ids.begin(), bvh_.primitive_ids.end(), 0u);
        bvh_.nodes.resize(2 * size_t(count) - 1);
        if (config_.method == SahBvhBuilder::Method::sweep) scratch_.resize(count);
        build_subtree({0, count, 0, 1, 0});
        remove_unused_slots();
        return std::move(bvh_);
    }

  private:
    void build_subtree(const Subtree& tree) {
        Box box;
        SplitInput input{boxes_, std::span(bvh_.primitive_ids).subspan(tree.begin, tree.count()), {}};
        for (const uint32_t id : input.ids) {
            box.extend(boxes_[id]);
            input.centroids.extend(compute_centroid(boxes_[id]));
        }
        BvhNode& node = bvh_.nodes[tree.root_slot];
        node.lower = box.lower, node.upper = box.upper;
        const uint32_t left_count = split(tree, input, compute_half_area(box));
        if (left_count == 0) {
            node.first = tree.begin, node.primitive_count = tree.count();
            return;
        }
        node.first = tree.free_slot;
        const uint32_t middle = tree.begin + left_count;
        const uint32_t slot = tree.free_slot;
        const Subtree left{tree.begin, middle, slot, slot + 2, tree.depth + 1};
        const Subtree right{middle, tree.end, slot + 1, slot + 2 * left_count, tree.depth + 1};
        if (tree.count() >= kParallelCount) {
            parallel_invoke([&] { build_subtree(left); }, [&] { build_subtree(right); });
        } else {
            build_subtree(left);
            build_subtree(right);
        }
    }

    /// Whether sets of `count` on level `depth` can be halved down to leaves within the greatest depth.
    bool fits(uint32_t count, int depth) const {
        const int levels = std::min(config_.max_depth - depth, 30);
        return count <= uint64_t(config_.max_leaf_size) << levels;
    }

    /// Size of the left side, which is then at the front of the ids; 0: make a leaf.
    uint32_t split(const Subtree& tree, const SplitInput& input, double half_area) {
        const uint32_t count = tree.count();
        if (count == 1 || tree.depth == config_.max_depth) return 0;
        const bool may_be_leaf = count <= config_.max_leaf_size;
        const bool is_swept = config_.method == SahBvhBuilder::Method::sweep || count <= kSmallCount;
        std::array<SweepEntry, kSmallCount> small;
        std::span<SweepEntry> scratch;
        if (count <= kSmallCount)
            scratch = std::span(small).first(count);
        else if (is_swept)
            scratch = std::span(scratch_).subspan(tree.begin, count);
        SahSplit best;
        if (tree.depth < kMaxSahDepth && half_area > 0)
            best = is_swept ? find_sweep_split(input, scratch) : find_binned_split(input, config_.bin_count);
        if (!best.is_valid() || !fits(best.imbalance, tree.depth + 1))
            return may_be_leaf ? 0 : apply_median_split(input);
        const double leaf_cost = double(config_.intersection_cost) * count;
        const double split_cost = config_.traversal_cost + config_.intersection_cost * best.cost / half_area;
        if (may_be_leaf && leaf_cost <= split_cost) return 0;
        return is_swept ? apply_sweep_split(input, best, scratch)
                        : apply_binned_split(input, best, config_.bin_count);
    }

    void remove_unused_slots() {
        std::vector<BvhNode>& nodes = bvh_.nodes;
        // Inner nodes have first > 0 and leaves have primitives, so a slot with neither was never used.
        const auto is_used = [](const BvhNode& node) { return node.first > 0 || node.is_leaf(); };
        std::vector<uint32_t> new_slot(nodes.size());
        uint32_t used = 0;
        for (size_t k = 0; k < nodes.size(); ++k) {
            new_slot[k] = used;
            used += is_used(nodes[k]) ? 1 : 0;
        }
        if (used == nodes.size()) return;
        for (size_t k = 0; k < nodes.size(); ++k) {
            if (!is_used(nodes[k])) continue;
            BvhNode node = nodes[k];
            if (!node.is_leaf()) node.first = new_slot[node.first];
            nodes[new_slot[k]] = node;
        }
        nodes.resize(used);
        nodes.shrink_to_fit();
    }

    std::span<const Box> boxes_;
    const SahBvhBuilder::Config& config_;
    std::vector<SweepEntry> scratch_;
    Bvh bvh_;
};

} // namespace

Bvh SahBvhBuilder::build(std::span<const Box> boxes, const Config& config) {
    DCHECK(config.bin_count >= 2 && config.bin_count <= kMaxBinCount);
    DCHECK(config.traversal_cost > 0 && config.intersection_cost > 0);
    DCHECK(config.max_leaf_size >= 1 && config.max_leaf_size <= 8);
    DCHECK(config.max_depth >= 1 && config.max_depth <= kMaxBvhDepth);
    if (boxes.empty()) return {};
    if (boxes.size() > kMaxPrimitiveCount)
        throw Error(ErrorKind::out_of_memory,
                    {"a bounding volume hierarchy holds at most 2^30 primitives", "", "split the scene"});
    return SahBuild(boxes, config).run();
}

} // namespace relief
