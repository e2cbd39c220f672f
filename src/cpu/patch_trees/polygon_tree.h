// What rays of the CPU engine walk through a surface without displacement: eight-wide nodes whose leaves are
// blocks of eight triangles, corners and all, so that a ray needs nothing but the tree.
#pragma once

#include <cstdint>
#include <vector>

#include "base/huge_pages.h"
#include "bvh/wide_children.h"
#include "surface/patch/surface.h"

namespace relief::cpu {

/// Boxes of up to eight children: lower x y z, upper x y z. They fill the slots from 0; empty slots have
/// lower +inf, upper -inf. A leaf is one block. Floats, where WideNode has bytes: there are as many triangles
/// as nodes have room for, not a patch of a thousand a leaf, and a ray's tests need no decoding.
struct alignas(64) PolygonNode : WideChild {
    float bounds[6][8];
    uint32_t child[8];
};

/// Up to eight triangles: each a triangle, a quad or half a quad of the surface. Empty lanes are NaN.
struct alignas(64) TriangleBlock {
    float corner[3][3][8]; ///< [corner][axis]
    uint32_t triangle[8];  ///< 2 patch + is_upper

    static constexpr uint32_t kWidth = 8;
};

struct PolygonTree {
    std::vector<PolygonNode, HugePageAllocator<PolygonNode>>
        nodes; ///< node 0 is the root; empty: no polygons
    std::vector<TriangleBlock, HugePageAllocator<TriangleBlock>> blocks;
    Box bounds; ///< exact union of the boxes of the polygons

    size_t byte_count() const {
        return nodes.size() * sizeof(PolygonNode) + blocks.size() * sizeof(TriangleBlock);
    }
};

/// `surface` has no displacement. The same for any number of threads. Throws Error for 2^28 patches or more.
PolygonTree build_polygon_tree(const Surface& surface);

} // namespace relief::cpu
