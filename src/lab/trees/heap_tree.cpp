#include "lab/trees/heap_tree.h"

#include <algorithm>
#include <bit>

#include <fmt/format.h>

#include "base/check.h"
#include "base/parallel.h"
#include "formulas/tree.h"
#include "lab/walks/trail.h"
#include "relief/error.h"

namespace relief {

namespace {

using scalar::HeapBlock;
using scalar::HeapBrick;
using scalar::kBrickLevels;

TreeNode make_heap_node(const AxisBvh& tree, uint32_t index) {
    const BvhNode& source = tree.bvh.nodes[index];
    TreeNode node = std::bit_cast<TreeNode>(source);
    // The way down follows from the key.
    if (!source.is_leaf()) node.first = 0, node.word = scalar::make_inner_word(tree.axes[index]);
    return node;
}

void set_bit(uint32_t& low, uint32_t& high, uint32_t place) {
    (place < 32 ? low : high) |= 1u << (place & 31u);
}

bool has_bit(uint32_t low, uint32_t high, uint32_t place) {
    return ((place < 32 ? low : high) >> (place & 31u) & 1u) != 0;
}

struct KeyedNode {
    uint64_t key;
    uint32_t node;
};

/// Level by level, in key order: slots of pairs in the order of their parents. Copies in parallel.
class SuccinctBuild {
  public:
    explicit SuccinctBuild(const AxisBvh& tree) : tree_(tree), bvh_(tree.bvh) {}

    SuccinctHeap run() {
        heap_.depth = tree_.depth;
        heap_.primitive_ids = bvh_.primitive_ids;
        const uint32_t pairs = uint32_t(bvh_.nodes.size() / 2);
        // Four to eight bits of the flat part a pair: most nodes are found by one look into it.
        const int levels = pairs > 0 ? int(std::bit_width(pairs)) + 1 : 0;
        heap_.form.flat_levels = uint32_t(std::min(levels, heap_.depth));
        heap_.blocks.resize(((size_t(2) << heap_.form.flat_levels) + 63) / 64);
        first_children_.reserve(pairs);
        add_flat_levels();
        for (size_t k = 0; k < brick_roots_.size(); ++k) add_brick(brick_roots_[k]);
        rank_blocks();
        copy_nodes();
        return std::move(heap_);
    }

  private:
    void add_pair(uint32_t node) { first_children_.push_back(bvh_.nodes[node].first); }

    void copy_nodes() {
        heap_.nodes.resize(bvh_.nodes.size() + 1);
        heap_.nodes[0].word = scalar::kEmptySlot;
        heap_.nodes[1] = make_heap_node(tree_, 0);
        parallel_for("heap_nodes", first_children_.size(), 8192, [&](size_t begin, size_t end) {
            for (size_t pair = begin; pair < end; ++pair)
                for (uint32_t side = 0; side < 2; ++side)
                    heap_.nodes[2 + 2 * pair + side] = make_heap_node(tree_, first_children_[pair] + side);
        });
    }

    void add_children(std::vector<KeyedNode>& list, const KeyedNode& parent) const {
        const uint32_t first = bvh_.nodes[parent.node].first;
        list.push_back({2 * parent.key, first});
        list.push_back({2 * parent.key + 1, first + 1});
    }

    void add_flat_levels() {
        std::vector<KeyedNode> level{{1, 0}};
        for (uint32_t depth = 0; depth <= heap_.form.flat_levels; ++depth) {
            std::vector<KeyedNode> next;
            for (const KeyedNode& node : level) {
                if (bvh_.nodes[node.node].is_leaf()) continue;
                HeapBlock& block = heap_.blocks[node.key / 64];
                set_bit(block.inner_low, block.inner_high, uint32_t(node.key % 64));
                if (depth == heap_.form.flat_levels) {
                    brick_roots_.push_back(node.node);
                    continue;
                }
                add_pair(node.node);
                ++heap_.form.flat_pairs;
                add_children(next, node);
            }
            level = std::move(next);
        }
    }

    void add_brick(uint32_t root) {
        HeapBrick brick{};
        brick.first_pair = uint32_t(first_children_.size());
        brick.first_brick = uint32_t(brick_roots_.size());
        std::vector<KeyedNode> level{{1, root}};
        for (uint32_t depth = 0; depth <= kBrickLevels; ++depth) {
            std::vector<KeyedNode> next;
            for (const KeyedNode& node : level) {
                if (bvh_.nodes[node.node].is_leaf()) continue;
                if (depth == kBrickLevels) {
                    set_bit(brick.deeper_low, brick.deeper_high, uint32_t(node.key - 64));
                    brick_roots_.push_back(node.node);
                    continue;
                }
                set_bit(brick.inner_low, brick.inner_high, uint32_t(node.key));
                add_pair(node.node);
                add_children(next, node);
            }
            level = std::move(next);
        }
        heap_.bricks.push_back(brick);
    }

    void rank_blocks() {
        uint32_t rank = 0;
        for (HeapBlock& block : heap_.blocks) {
            block.rank = rank;
            rank += uint32_t(std::popcount(block.inner_low) + std::popcount(block.inner_high));
        }
    }

    const AxisBvh& tree_;
    const Bvh& bvh_;
    std::vector<uint32_t> first_children_; ///< left node of each pair
    std::vector<uint32_t> brick_roots_;    ///< in the order of brick numbers
    SuccinctHeap heap_;
};

} // namespace

SuccinctHeap make_succinct_heap(const AxisBvh& tree) {
    DCHECK(tree.axes.size() == tree.bvh.nodes.size());
    if (tree.bvh.nodes.empty()) return {};
    const int limit = int(scalar::kTrailLevels64);
    if (tree.depth > limit)
        throw Error(ErrorKind::out_of_memory,
                    {fmt::format("a tree of {} levels below its root does not fit, room is for {}",
                                 tree.depth, limit),
                     "succinct heap", "give the builder a smaller greatest depth"});
    return SuccinctBuild(tree).run();
}

bool contains_key(const DenseHeap& heap, uint64_t key) {
    return key < heap.nodes.size() && heap.nodes[key].word != scalar::kEmptySlot;
}

/// Its parent has to be an inner node: what find_succinct_slot takes for granted, bit by bit.
bool contains_key(const SuccinctHeap& heap, uint64_t key) {
    if (heap.blocks.empty() || key == 0) return false;
    const uint64_t parent = key / 2;
    if (parent == 0) return true;
    const uint32_t level = uint32_t(std::bit_width(parent)) - 1;
    const uint32_t flat_levels = heap.form.flat_levels;
    uint32_t depth = level > flat_levels ? level - flat_levels : 0;
    const uint64_t flat_key = parent >> depth;
    const HeapBlock& block = heap.blocks[flat_key / 64];
    const uint32_t place = uint32_t(flat_key % 64);
    if (!has_bit(block.inner_low, block.inner_high, place)) return false;
    if (level < flat_levels) return true;
    const uint32_t rank = block.rank + scalar::rank_bits(block.inner_low, block.inner_high, place);
    const HeapBrick* brick = &heap.bricks[rank - heap.form.flat_pairs];
    while (depth >= kBrickLevels) {
        depth -= kBrickLevels;
        const uint32_t local = uint32_t(parent >> depth & 63u);
        if (!has_bit(brick->deeper_low, brick->deeper_high, local)) return false;
        brick = &heap.bricks[brick->first_brick +
                             scalar::rank_bits(brick->deeper_low, brick->deeper_high, local)];
    }
    const uint32_t local = 1u << depth | uint32_t(parent & ((uint64_t(1) << depth) - 1));
    return has_bit(brick->inner_low, brick->inner_high, local);
}

int compute_depth(const DenseHeap& heap) {
    size_t last = heap.nodes.size();
    while (last > 1 && heap.nodes[last - 1].word == scalar::kEmptySlot) --last;
    return last > 1 ? int(std::bit_width(last - 1)) - 1 : 0;
}

size_t count_used_slots(const DenseHeap& heap) {
    return size_t(std::count_if(heap.nodes.begin(), heap.nodes.end(),
                                [](const TreeNode& node) { return node.word != scalar::kEmptySlot; }));
}

} // namespace relief
