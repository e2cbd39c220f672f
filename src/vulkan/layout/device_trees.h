// Trees that are built and walked on the device: bindings of a table of their own, and the structs that
// cross.
#ifndef RELIEF_DEVICE_TREES_H
#define RELIEF_DEVICE_TREES_H
#include "formulas/begin.h"

// The set layout is that of bindings.h, and so are the texel formats behind each number; what a number means
// is not. Storage buffers of a walk.
const uint kBindTreeRays = 0u;  ///< TreeRay
const uint kBindTreeHits = 1u;  ///< TreeHit
const uint kBindStartKeys = 2u; ///< HeapKey: where in a heap each ray starts
const uint kBindLeafKeys =
    3u; ///< HeapKey: the leaf of each hit, where the next ray may start; else the start
const uint kBindWalkCounts = 4u; ///< RayCounts
const uint kBindHeapBlocks = 5u; ///< HeapBlock
const uint kBindHeapBricks = 6u; ///< HeapBrick
const uint kBindWalkState = 7u;  ///< WalkState

// Storage buffers of a build. kBindPairs, kBindSortedPairs, kBindHistogram and kBindCounters are the sort's.
const uint kBindBuildBoxes = 8u;     ///< float: six a primitive
const uint kBindBuildCodes = 9u;     ///< uvec2: codes of 63 bits, one a primitive
const uint kBindBuildNumbers = 10u;  ///< uint: cuts before each sorted entry, and in all
const uint kBindBuildSums = 11u;     ///< uint: cuts of each tile of entries, later those before it
const uint kBindBuildNodes = 12u;    ///< uvec4: two a node
const uint kBindBuildIds = 16u;      ///< uint
const uint kBindBuildParents = 17u;  ///< uint
const uint kBindBuildSkips = 18u;    ///< uint
const uint kBindBuildState = 19u;    ///< BuildState; kBindCounters of the sort
const uint kBindBuildArrivals = 20u; ///< uint: children of each pair whose boxes are done
const uint kBindBuildHeights = 21u;  ///< uint: levels below the parent of each pair

// Uniform texel buffers.
const uint kBindTreeNodes = 32u;     ///< rgba32ui: two a TreeNode
const uint kBindKdNodes = 35u;       ///< rg32ui: KdNode
const uint kBindMeshTriangles = 36u; ///< rgba32ui: three vertices and 0
const uint kBindTreeParents = 37u;   ///< r32ui
const uint kBindTreeSkips = 38u;     ///< r32ui
const uint kBindKdBoxes = 39u;       ///< rgba32ui: two a KdBox
const uint kBindTreeIds = 42u;       ///< r32ui: primitives in the order of the leaves
const uint kBindMeshPositions = 43u; ///< rgba32f

/// Hits lie in (t_min, t_max].
struct TreeRay {
    Vec3 origin;
    float t_min;
    Vec3 direction;
    float t_max;
};

struct TreeHit {
    float t;        ///< infinity: nothing
    uint primitive; ///< kNone: nothing; of hits at one distance the lowest, of any hits whichever came first
    float weight_b, weight_c; ///< of the second and third corner
};

/// What the walk of one ray did.
struct RayCounts {
    uint box_tests, primitive_tests;
    uint restarts; ///< ways down that began again further up
    uint bytes;    ///< of nodes, links and directories; not of primitives
};

/// Read for a primitive test: an id, three indices padded to 16 bytes, and as much for each vertex.
const uint kTriangleTestBytes = 68u;

struct WalkState {
    uint rays_lost; ///< whose walk the device ended
};

struct WalkPush {
    uint ray_count;
    uint root; ///< node; heaps: key; kNoNode or key 0: no tree
    uint is_any;
    uint has_start_keys, has_leaf_keys;
    uint flat_levels, flat_pairs; ///< HeapForm
    Vec3 cell_lower, cell_upper;  ///< of the root of a kd-tree
};

/// What the kernels of a build tell each other; zeroed by the host but for the bounds.
struct BuildState {
    uint primitive_count;
    uint cut_count;
    uint depth;       ///< edges on the longest way down
    uint loops_ended; ///< by the device, too early
    uint lower[3];    ///< of all boxes, by order_float
    uint upper[3];
};
const uint kBuildCountWord = 0u; ///< of BuildState: what the sort reads

struct BuildPush {
    uint primitive_count;
    uint max_leaf_size;
    uint level; ///< of a heap; 0: the root's
    uint step;  ///< of codes of 63 bits: 0 fetches the high words, 1 the whole codes
};

/// Entries of a tile whose cuts are counted by one group, as the sort cuts them.
const uint kBuildGroupSize = 256u;
const uint kBuildItemCount = 8u;
const uint kBuildTileSize = 2048u;

#include "formulas/end.h"
#endif
