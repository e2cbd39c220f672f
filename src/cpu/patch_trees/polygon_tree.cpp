#include "cpu/patch_trees/polygon_tree.h"

#include <limits>

#include "base/parallel.h"
#include "bvh/sah_bvh.h"
#include "prepare/scene_trees.h"
#include "relief/error.h"

namespace relief::cpu {

namespace {

constexpr size_t kMaxPolygonCount = size_t(1) << 28;

/// A block is tested at once and costs no more than a node: what fits one is not split.
SahBvhBuilder::Config choose_config(const Surface& surface) {
    bool has_quads = false;
    for (const Quad quad : surface.quads) has_quads = has_quads || !quad.is_triangle();
    SahBvhBuilder::Config config;
    config.max_leaf_size = has_quads ? TriangleBlock::kWidth / 2 : TriangleBlock::kWidth;
    config.intersection_cost = config.traversal_cost / TriangleBlock::kWidth;
    return config;
}

/// Adds one triangle to the next free lane.
void add_triangle(const Surface& surface, uint32_t patch, uint32_t is_upper, uint32_t lane,
                  TriangleBlock& block) {
    const Quad quad = surface.quads[patch];
    const uint32_t vertex[3] = {quad.vertex[0], quad.vertex[1 + is_upper], quad.vertex[2 + is_upper]};
    for (int corner = 0; corner < 3; ++corner) {
        const Vec3f& p = surface.position(vertex[corner]);
        block.corner[corner][0][lane] = p.x;
        block.corner[corner][1][lane] = p.y;
        block.corner[corner][2][lane] = p.z;
    }
    block.triangle[lane] = 2 * patch + is_upper;
}

void fill_block(const Surface& surface, const Bvh& bvh, const BvhNode& leaf, TriangleBlock& block) {
    uint32_t lane = 0;
    for (uint32_t k = leaf.first; k < leaf.first + leaf.primitive_count; ++k) {
        const uint32_t patch = bvh.primitive_ids[k];
        add_triangle(surface, patch, 0, lane++, block);
        if (!surface.quads[patch].is_triangle()) add_triangle(surface, patch, 1, lane++, block);
    }
    constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
    for (; lane < TriangleBlock::kWidth; ++lane) {
        for (auto& corner : block.corner)
            for (auto& coordinates : corner) coordinates[lane] = kNothing;
        block.triangle[lane] = kNoIndex;
    }
}

PolygonNode encode_node(const WideNodeParts& parts) {
    PolygonNode node;
    for (size_t k = 0; k < parts.child.size(); ++k) {
        for (int axis = 0; axis < 3; ++axis) {
            node.bounds[axis][k] = get_component(parts.boxes[k].lower, axis);
            node.bounds[3 + axis][k] = get_component(parts.boxes[k].upper, axis);
        }
        node.child[k] = parts.child[k];
    }
    return node;
}

} // namespace

PolygonTree build_polygon_tree(const Surface& surface) {
    if (surface.quads.empty()) return {};
    if (surface.quads.size() > kMaxPolygonCount)
        throw Error(ErrorKind::out_of_memory,
                    {"the tree of one surface holds at most 2^28 polygons", surface.name, "split the mesh"});
    const Bvh bvh = SahBvhBuilder::build(compute_patch_boxes(surface), choose_config(surface));
    PolygonTree tree;
    tree.bounds = bvh.nodes[0].box();
    std::vector<const BvhNode*> leaves;
    const auto make_leaf = [&](const BvhNode& leaf) {
        leaves.push_back(&leaf);
        return PolygonNode::make_leaf(uint32_t(leaves.size() - 1), 1);
    };
    make_wide_nodes(bvh, WideCollapse(bvh), tree.nodes, make_leaf, encode_node);
    tree.blocks.resize(leaves.size());
    parallel_for("triangle blocks", leaves.size(), 1024, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) fill_block(surface, bvh, *leaves[k], tree.blocks[k]);
    });
    return tree;
}

} // namespace relief::cpu
