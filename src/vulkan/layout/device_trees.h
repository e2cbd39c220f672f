// Trees built and walked on the device by themselves: bindings of a separate table, and structs.
#ifndef RELIEF_DEVICE_TREES_H
#define RELIEF_DEVICE_TREES_H
#include "formulas/begin.h"

// Set layout and texel formats of bindings.h; the numbers differ. Storage buffers of a traversal.
const uint kBindTreeRays = 0u;  ///< TreeRay
const uint kBindTreeHits = 1u;  ///< TreeHit
const uint kBindStartKeys = 2u; ///< HeapKey: start node of each ray in a heap
const uint kBindLeafKeys =
    3u; ///< HeapKey: the leaf of each hit, as start of the next ray; else the start node
const uint kBindWalkCounts = 4u; ///< RayCounts
const uint kBindHeapBlocks = 5u; ///< HeapBlock
const uint kBindHeapBricks = 6u; ///< HeapBrick
const uint kBindWalkState = 7u;  ///< WalkState

// Storage buffers of a build. kBindPairs, kBindSortedPairs, kBindHistogram and kBindCounters are the sort's.
const uint kBindBuildBoxes = 8u;     ///< float: six per primitive
const uint kBindBuildCodes = 9u;     ///< uvec2: 63-bit codes, one per primitive
const uint kBindBuildNumbers = 10u;  ///< uint: splits before each sorted entry, and in total
const uint kBindBuildSums = 11u;     ///< uint: splits in each tile of entries, later their prefix sum
const uint kBindBuildNodes = 12u;    ///< uvec4: two per node
const uint kBindBuildIds = 16u;      ///< uint
const uint kBindBuildParents = 17u;  ///< uint
const uint kBindBuildSkips = 18u;    ///< uint
const uint kBindBuildState = 19u;    ///< BuildState; kBindCounters of the sort
const uint kBindBuildArrivals = 20u; ///< uint: children of each pair whose boxes are done
const uint kBindBuildHeights = 21u;  ///< uint: levels below the parent of each pair

// Uniform texel buffers.
const uint kBindTreeNodes = 32u;     ///< rgba32ui: two per TreeNode
const uint kBindKdNodes = 35u;       ///< rg32ui: KdNode
const uint kBindMeshTriangles = 36u; ///< rgba32ui: three vertices and 0
const uint kBindTreeParents = 37u;   ///< r32ui
const uint kBindTreeSkips = 38u;     ///< r32ui
const uint kBindKdBoxes = 39u;       ///< rgba32ui: two per KdBox
const uint kBindTreeIds = 42u;       ///< r32ui: primitives in leaf order
const uint kBindMeshPositions = 43u; ///< rgba32f

/// Hits lie in (t_min, t_max].
struct TreeRay {
    Vec3 origin;
    float t_min;
    Vec3 direction;
    float t_max;
};

struct TreeHit {
    float t;        ///< infinity: no hit
    uint primitive; ///< kNone: no hit; the lowest among ties; for any-hit queries the first one found
    float weight_b, weight_c; ///< of the second and third corner
};

/// Statistics of the traversal of one ray.
struct RayCounts {
    uint box_tests, primitive_tests;
    uint restarts; ///< restarts of the descent
    uint bytes;    ///< of nodes, links and directories; not of primitives
};

/// Bytes read per primitive test: an id, three indices padded to 16 bytes, and 16 bytes per vertex.
const uint kTriangleTestBytes = 68u;

struct WalkState {
    uint rays_lost; ///< rays whose traversal the device cut short
};

struct WalkPush {
    uint ray_count;
    uint root; ///< node; heaps: key; kNoNode or key 0: no tree
    uint is_any;
    uint has_start_keys, has_leaf_keys;
    uint flat_levels, flat_pairs; ///< HeapForm
    Vec3 cell_lower, cell_upper;  ///< root cell of a kd-tree
};

/// Build state shared by kernels; cleared by the host except for the bounds.
struct BuildState {
    uint primitive_count;
    uint cut_count;
    uint depth;       ///< edges on the longest path from the root
    uint loops_ended; ///< loops that the device ended early
    uint lower[3];    ///< of all boxes, by order_float
    uint upper[3];
};
const uint kBuildCountWord = 0u; ///< of BuildState: what the sort reads

struct BuildPush {
    uint primitive_count;
    uint max_leaf_size;
    uint level; ///< of a heap; 0: the root
    uint step;  ///< of sorting 63-bit codes: 0 fetches the high words, 1 the whole codes
};

/// Entries per tile whose splits are counted by one group; the same tiles as in the sort.
const uint kBuildGroupSize = 256u;
const uint kBuildItemCount = 8u;
const uint kBuildTileSize = 2048u;

#include "formulas/end.h"
#endif
