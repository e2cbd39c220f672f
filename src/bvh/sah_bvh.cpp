#include "bvh/sah_bvh.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "base/check.h"
#include "base/parallel.h"
#include "bvh/sah_split.h"

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

/// A subtree: primitives [begin, end) and the node slots reserved for it. n primitives need at most 2n - 1
/// nodes, so slots are assigned in advance and the layout is independent of the threads.
struct Subtree {
    uint32_t begin;
    uint32_t end;
    uint32_t root_slot;
    uint32_t free_slot; ///< the root's descendants use free_slot, ..., free_slot + 2 (end - begin) - 3
    int depth;

    uint32_t count() const { return end - begin; }
};

/// Fewer bins for smaller sets: most of the time of a build goes into sets of a few dozen.
int choose_bin_count(uint32_t count, int most) { return std::min(most, 4 + int(std::min(count, 1024u) / 8)); }

class SahBuild {
  public:
    SahBuild(std::span<const Box> boxes, const SahBvhBuilder::Config& config)
        : boxes_(boxes), config_(config) {}

    Bvh run() {
        const uint32_t count = uint32_t(boxes_.size());
        SetBounds bounds;
        members_.reserve(count);
        for (uint32_t id = 0; id < count; ++id) {
            members_.push_back(make_numbered_box(boxes_[id], id));
            bounds.extend(members_.back());
        }
        bvh_.nodes.resize(2 * size_t(count) - 1);
        if (config_.method == SahBvhBuilder::Method::sweep) {
            sweep_entries_.resize(count);
            sweep_members_.resize(count);
        }
        build_subtree({0, count, 0, 1, 0}, bounds);
        bvh_.primitive_ids.reserve(count);
        for (const NumberedBox& member : members_) bvh_.primitive_ids.push_back(member.id);
        remove_unused_slots();
        return std::move(bvh_);
    }

  private:
    void build_subtree(const Subtree& tree, const SetBounds& bounds) {
        BvhNode& node = bvh_.nodes[tree.root_slot];
        const Box box = bounds.box.to_box();
        node.lower = box.lower, node.upper = box.upper;
        const SplitSets sets = split(tree, bounds);
        if (sets.left_count == 0) {
            node.first = tree.begin, node.primitive_count = tree.count();
            return;
        }
        node.first = tree.free_slot;
        const uint32_t middle = tree.begin + sets.left_count;
        const uint32_t slot = tree.free_slot;
        const Subtree left{tree.begin, middle, slot, slot + 2, tree.depth + 1};
        const Subtree right{middle, tree.end, slot + 1, slot + 2 * sets.left_count, tree.depth + 1};
        if (tree.count() >= kParallelCount) {
            parallel_invoke([&] { build_subtree(left, sets.bounds[0]); },
                            [&] { build_subtree(right, sets.bounds[1]); });
        } else {
            build_subtree(left, sets.bounds[0]);
            build_subtree(right, sets.bounds[1]);
        }
    }

    /// Whether sets of `count` on level `depth` can be halved down to leaves within the greatest depth.
    bool fits(uint32_t count, int depth) const {
        const int levels = std::min(config_.max_depth - depth, 30);
        return count <= uint64_t(config_.max_leaf_size) << levels;
    }

    /// Nothing on the left side: make a leaf.
    SplitSets split(const Subtree& tree, const SetBounds& bounds) {
        const uint32_t count = tree.count();
        if (count == 1 || tree.depth == config_.max_depth) return {};
        const bool may_be_leaf = count <= config_.max_leaf_size;
        const double leaf_cost = double(config_.intersection_cost) * count;
        if (may_be_leaf && leaf_cost <= config_.traversal_cost) return {};
        const SplitInput input{std::span(members_).subspan(tree.begin, count), bounds.centroids};
        const bool is_swept = config_.method == SahBvhBuilder::Method::sweep || count <= kSmallCount;
        std::array<SweepEntry, kSmallCount> small_entries;
        std::array<NumberedBox, kSmallCount> small_members;
        SweepScratch scratch;
        if (count <= kSmallCount)
            scratch = {std::span(small_entries).first(count), small_members};
        else if (is_swept)
            scratch = {std::span(sweep_entries_).subspan(tree.begin, count),
                       std::span(sweep_members_).subspan(tree.begin, count)};
        const int bin_count = choose_bin_count(count, config_.bin_count);
        const double half_area = bounds.box.half_area();
        SahSplit best;
        if (tree.depth < kMaxSahDepth && half_area > 0)
            best = is_swept ? find_sweep_split(input, scratch) : find_binned_split(input, bin_count);
        if (!best.is_valid() || !fits(best.imbalance, tree.depth + 1))
            return may_be_leaf ? SplitSets{} : apply_median_split(input);
        const double split_cost = config_.traversal_cost + config_.intersection_cost * best.cost / half_area;
        if (may_be_leaf && leaf_cost <= split_cost) return {};
        return is_swept ? apply_sweep_split(input, best, scratch)
                        : apply_binned_split(input, best, bin_count);
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
    std::vector<NumberedBox> members_;
    std::vector<SweepEntry> sweep_entries_;
    std::vector<NumberedBox> sweep_members_;
    Bvh bvh_;
};

} // namespace

Bvh SahBvhBuilder::build(std::span<const Box> boxes, const Config& config) {
    DCHECK(config.bin_count >= 2 && config.bin_count <= kMaxBinCount);
    DCHECK(config.traversal_cost > 0 && config.intersection_cost > 0);
    DCHECK(config.max_leaf_size >= 1 && config.max_leaf_size <= 8);
    DCHECK(config.max_depth >= 1 && config.max_depth <= kMaxBvhDepth);
    if (boxes.empty()) return {};
    check_primitive_count(boxes.size(), kMaxPrimitiveCount, "SAH BVH",
                          "split the scene into instances of several meshes");
    return SahBuild(boxes, config).run();
}

} // namespace relief
