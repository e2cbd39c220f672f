// Trees and the ways through them, by name.
#pragma once

namespace relief {

/// Over instances, and over the patches of a mesh.
enum class StructureKind { bvh, lbvh, kdtree };
/// How a ray walks them; see docs/structures.md. `automatic` is the first of available_traversals().
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

/// What the surface-area heuristic reckons with, relative to each other; those of GRAPP 2019.
struct SahCosts {
    float traversal = 3.0f;    ///< of one inner node, > 0
    float intersection = 1.5f; ///< of one primitive, > 0
};

/// As the command spells it: "skip-link".
const char* traversal_name(TraversalKind traversal);
const char* structure_name(StructureKind structure);

} // namespace relief
