// The one walk through eight-wide trees, whatever goes through them: one ray, a packet or a bundle.
#pragma once

#include <concepts>

#include "base/check.h"
#include "bvh/wide_bvh.h"
#include "cpu/patch_trees/patch_tree_cache.h"
#include "formulas/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// Depth of a binary tree is bounded far below this, and so is that of the wide one.
inline constexpr uint32_t kStackSize = 1024;

/// What goes through a tree of `Node`s. An Entry names a child and says how much of the walker may enter it.
template <class Walker, class Node>
concept TreeWalker = requires(Walker& walker, const Node& node, typename Walker::Entry& top,
                              typename Walker::Entry* stack, uint32_t& size) {
    { top.child } -> std::convertible_to<uint32_t>;
    /// Of an entry from the stack: false where nothing can be found below it any more.
    { walker.enter(top) } -> std::same_as<bool>;
    /// Puts the children that are entered on the stack, the nearest last. True: the nearest is `top` instead.
    { walker.open(node, top, stack, size) } -> std::same_as<bool>;
};

enum EntryOrder { kNearestFirst, kFarthestFirst };

/// Inserts into entries[0, count), sorted by entry distance, behind equal ones.
template <EntryOrder kOrder, class Entry>
RELIEF_INLINE void insert_sorted(const Entry& entry, Entry* entries, uint32_t& count) {
    const auto comes_before = [&](const Entry& other) {
        return kOrder == kNearestFirst ? entry.entry < other.entry : entry.entry > other.entry;
    };
    uint32_t slot = count++;
    for (; slot > 0 && comes_before(entries[slot - 1]); --slot) entries[slot] = entries[slot - 1];
    entries[slot] = entry;
}

/// Calls visit_leaf(entry) for leaves below `first` that the walker enters, nearest first, until it is true.
template <class Nodes, class Walker, class VisitLeaf>
RELIEF_INLINE bool walk_wide_tree(const Nodes& nodes, Walker& walker, const typename Walker::Entry& first,
                                  uint32_t& visited, VisitLeaf visit_leaf) {
    using Node = typename Nodes::value_type;
    static_assert(TreeWalker<Walker, Node>);
    if (nodes.empty()) return false;
    typename Walker::Entry stack[kStackSize];
    stack[0] = first;
    for (uint32_t size = 1; size > 0;) {
        typename Walker::Entry top = stack[--size];
        bool is_entered = walker.enter(top);
        while (is_entered && !Node::is_leaf(top.child)) {
            ++visited;
            DCHECK(size + 8 <= kStackSize);
            is_entered = walker.open(nodes[top.child], top, stack, size);
        }
        if (is_entered && visit_leaf(top)) return true;
    }
    return false;
}

/// The same of what the leaves hold: visit(primitive, entry).
template <class Walker, class Visit>
RELIEF_INLINE bool walk_primitives(const WideBvh& tree, cpu::TraceContext& context, Walker& walker,
                                   const typename Walker::Entry& first, Visit visit) {
    uint32_t visited = 0;
    const bool has_ended = walk_wide_tree(
        tree.nodes, walker, first,
        visited, [&](const typename Walker::Entry& leaf) __attribute__((always_inline)) {
            const uint32_t begin = WideNode::leaf_first(leaf.child);
            const uint32_t end = begin + WideNode::leaf_count(leaf.child);
            for (uint32_t k = begin; k < end; ++k)
                if (visit(tree.primitive_at(k), leaf)) return true;
            return false;
        });
    context.counters.upper_nodes += visited;
    return has_ended;
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
