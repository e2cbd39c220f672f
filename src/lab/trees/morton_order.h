// Primitives in the order of the Morton codes of their centres: what linear trees are made from.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "math/box.h"

namespace relief {

/// Equal codes keep the order of their indices.
struct MortonOrder {
    std::vector<uint64_t> codes; ///< ascending
    std::vector<uint32_t> ids;
    Box scene; ///< union of all boxes: the codes are places in it
};

/// `code_bits`: 30 or 63 (formulas/morton.h). Boxes must be finite and not empty. Independent of the threads.
MortonOrder compute_morton_order(std::span<const Box> boxes, int code_bits);

} // namespace relief
