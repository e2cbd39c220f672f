// The upper tree of a small surface with the boxes of its nodes decoded: rays that walk it over and over are
// spared the decoding. That of a large surface stays as it is: there memory is what they wait for.
#pragma once

#include <vector>

#include "base/huge_pages.h"
#include "engine/cpu/polygon_tree.h"
#include "structures/wide_bvh.h"

namespace relief::cpu {

/// Node for node those of a WideBvh, child words included; empty: the WideBvh itself is to be walked.
using OpenNodes = std::vector<PolygonNode, HugePageAllocator<PolygonNode>>;

/// Empty where there are too many nodes.
OpenNodes open_nodes(const WideBvh& tree);

} // namespace relief::cpu
