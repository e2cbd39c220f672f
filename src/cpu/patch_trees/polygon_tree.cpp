#include "cpu/patch_trees/polygon_tree.h"

#include <algorithm>

#include "base/parallel.h"
#include "bvh/sah_bvh.h"
#include "bvh/wide_children.h"
#include "prepare/scene_trees.h"
#include "relief/error.h"

namespace relief::cpu {

namespace {

constexpr size_t kMaxPolygonCount = size_t(1) << 28;

/// A block is tested at once, however full it is, and no dearer than a node: what fits one is not split.
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

class Collapse {
  public:
    Collapse(const Surface& surface, const Bvh& bvh) : surface_(surface), bvh_(bvh), collapse_(bvh) {}

    PolygonTree run() {
        tree_.bounds = bvh_.nodes[0].box();
        tree_.blocks.resize(collapse_.leaf_count());
        tree_.nodes.resize(1);
        pending_.push_back({0, 0});
        while (!pending_.empty()) {
            const Pending next = pending_.back();
            pending_.pop_back();
            make_node(next);
        }
        tree_.nodes.shrink_to_fit();
        fill_blocks();
        return std::move(tree_);
    }

  private:
    struct Pending {
        uint32_t binary_node;
        uint32_t node;
    };

    void make_node(const Pending& pending) {
        const WideChildren list = collapse_.collect_children(pending.binary_node);
        PolygonNode node;
        for (int k = 0; k < kMaxWideChildCount; ++k) {
            const Box box = k < list.count ? bvh_.nodes[list.nodes[k]].box() : Box{};
            for (int axis = 0; axis < 3; ++axis) {
                node.bounds[axis][k] = get_component(box.lower, axis);
                node.bounds[3 + axis][k] = get_component(box.upper, axis);
            }
            node.child[k] = k < list.count ? make_child(list.nodes[k]) : PolygonNode::kNoChild;
        }
        tree_.nodes[pending.node] = node;
    }

    uint32_t make_child(uint32_t binary_node) {
        if (bvh_.nodes[binary_node].is_leaf()) {
            leaves_.push_back(binary_node);
            return PolygonNode::kLeafFlag | uint32_t(leaves_.size() - 1);
        }
        const uint32_t index = uint32_t(tree_.nodes.size());
        tree_.nodes.emplace_back();
        pending_.push_back({binary_node, index});
        return index;
    }

    void fill_blocks() {
        parallel_for("triangle blocks", leaves_.size(), 1024, [&](size_t begin, size_t end) {
            for (size_t k = begin; k < end; ++k) fill_block(bvh_.nodes[leaves_[k]], tree_.blocks[k]);
        });
    }

    void fill_block(const BvhNode& leaf, TriangleBlock& block) const {
        uint32_t lane = 0;
        for (uint32_t k = leaf.first; k < leaf.first + leaf.primitive_count; ++k) {
            const uint32_t patch = bvh_.primitive_ids[k];
            add_triangle(surface_, patch, 0, lane++, block);
            if (!surface_.quads[patch].is_triangle()) add_triangle(surface_, patch, 1, lane++, block);
        }
        constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
        for (; lane < TriangleBlock::kWidth; ++lane) {
            for (auto& corner : block.corner)
                for (auto& coordinates : corner) coordinates[lane] = kNothing;
            block.triangle[lane] = kNoIndex;
        }
    }

    const Surface& surface_;
    const Bvh& bvh_;
    const WideCollapse collapse_;
    PolygonTree tree_;
    std::vector<Pending> pending_;
    std::vector<uint32_t> leaves_;
};

} // namespace

PolygonTree build_polygon_tree(const Surface& surface) {
    if (surface.quads.empty()) return {};
    if (surface.quads.size() > kMaxPolygonCount)
        throw Error(ErrorKind::out_of_memory,
                    {"the tree of one surface holds at most 2^28 polygons", surface.name, "split the mesh"});
    const Bvh bvh = SahBvhBuilder::build(compute_patch_boxes(surface), choose_config(surface));
    return Collapse(surface, bvh).run();
}

} // namespace relief::cpu
