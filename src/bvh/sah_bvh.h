// Top-down surface-area-heuristic BVH (Wald 2007, binned; full sweep after MacDonald and Booth 1990).
#pragma once

#include <span>

#include "bvh/bvh.h"

namespace relief {

class SahBvhBuilder {
  public:
    enum class Method { binned, sweep };

    struct Config {
        Method method = Method::binned;
        int bin_count = 16;             ///< per axis, [2, 64]; binned only
        float traversal_cost = 1.0f;    ///< of one inner node, relative, > 0
        float intersection_cost = 1.0f; ///< of one primitive, relative, > 0
        uint32_t max_leaf_size = 4;     ///< primitives, [1, 8]
        /// Edges on the longest way down, [1, kMaxBvhDepth]. Sets are halved where they would not fit
        /// otherwise. Where even that is too deep, leaves on the last level hold all that is left.
        int max_depth = kMaxBvhDepth;
    };

    /// Boxes must be finite and not empty. The tree does not depend on the threads. No boxes: an empty tree.
    static Bvh build(std::span<const Box> boxes, const Config& config);
};

} // namespace relief
