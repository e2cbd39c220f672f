// Kd-tree by an exact O(n log n) sweep of the SAH (Wald and Havran 2006), without clipping.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formulas/tree.h"
#include "math/box.h"

namespace relief {

/// Leaves hold every primitive that touches their cell, so primitives occur in several leaves.
struct KdTree {
    Box bounds;                          ///< cell of the root
    std::vector<scalar::KdNode> nodes;   ///< node 0 is the root; none: no primitives
    std::vector<uint32_t> primitive_ids; ///< of the leaves
    std::vector<scalar::KdBox> cells;    ///< for backtracking, where Cells::kept; faces of `bounds`: infinity
    int depth = 0;                       ///< edges on the longest way down

    size_t byte_count() const {
        return nodes.size() * sizeof(scalar::KdNode) + primitive_ids.size() * sizeof(uint32_t) +
               cells.size() * sizeof(scalar::KdBox);
    }
};

/// Cells are closed: a primitive within rounding of a plane goes to both sides. No cell is thinner than that,
/// none is flat: one tree serves all three walks, and none loses a hit.
class SahKdTreeBuilder {
  public:
    enum class Cells { left_out, kept };

    struct Config {
        float traversal_cost = 3.0f;    ///< of one inner node, relative, > 0
        float intersection_cost = 1.5f; ///< of one primitive, relative, > 0
        float empty_factor = 1.0f;    ///< of the cost of a split that cuts off empty space, (0, 1]; often 0.8
        int max_depth = 0;            ///< edges, at most kMaxDepth; 0: 8 + 1.3 log2 of the primitives
        float max_duplication = 8.0f; ///< entries of leaves for each primitive at most, on average, >= 1
        Cells cells = Cells::left_out;
    };

    static constexpr int kMaxDepth = 62;

    /// Every box must be finite and not empty. The same for any number of threads. No boxes: an empty tree.
    /// Throws Error where nodes or entries could be more than their words count.
    static KdTree build(std::span<const Box> boxes, const Config& config);
};

} // namespace relief
