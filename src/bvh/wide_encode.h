// Boxes of eight children into the bytes of a wide node, rounded outward.
#pragma once

#include <array>

#include "bvh/wide_bvh.h"

namespace relief {

/// `bounds` holds the first `node.child_count` boxes; sets origin, exponents and codes.
void encode_boxes(WideNode& node, const Box& bounds, const std::array<Box, 8>& boxes);

WideNode encode_node(const WideNodeParts& parts);

} // namespace relief
