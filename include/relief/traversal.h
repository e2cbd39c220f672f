// Acceleration structures and traversals, by name.
#pragma once

#include <cstddef>

namespace relief {

/// Kind of the scene trees: over instances, and over the patches of a surface.
enum class StructureKind { bvh, lbvh, kdtree };
/// How rays traverse them; see docs/structures.md. `automatic` is the first of available_traversals().
enum class TraversalKind {
    automatic,
    wide,
    stack,
    restart_trail,
    parent_link,
    skip_link,
    trail,
    pair_trail,
    restart,
    push_down,
    backtrack
};
inline constexpr size_t kTraversalCount = size_t(TraversalKind::backtrack) + 1; ///< of the last one

/// Relative costs in the surface-area heuristic; the defaults are those of GRAPP 2019.
struct SahCosts {
    float traversal = 3.0f;    ///< of an inner node, > 0
    float intersection = 1.5f; ///< of a primitive, > 0
};

/// Name in command-line options, e.g. "skip-link".
const char* traversal_name(TraversalKind traversal);
const char* structure_name(StructureKind structure);

} // namespace relief
