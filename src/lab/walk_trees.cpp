#include "lab/walk_trees.h"

#include <algorithm>
#include <utility>

#include "bvh/sah_bvh.h"
#include "lab/trees/lbvh.h"
#include "lab/walks/trail.h"
#include "prepare/scene_trees.h"
#include "prepare/traversals.h"

namespace relief {

namespace {

constexpr uint32_t kPolygonsOfALeaf = 4;
constexpr uint32_t kMostPolygonsOfALeaf = 8; ///< where costs decide

AxisBvh build_binary(std::span<const Box> boxes, const RenderSettings& settings, uint32_t max_leaf_size) {
    if (settings.experiment.structure == StructureKind::lbvh) {
        LbvhBuilder::Config config;
        config.max_leaf_size = max_leaf_size;
        static_assert(LbvhBuilder::Config{}.code_bits + 30 <= int(scalar::kTrailLevels64));
        return LbvhBuilder::build(boxes, config);
    }
    SahBvhBuilder::Config config;
    config.max_leaf_size = max_leaf_size;
    config.max_depth = int(scalar::kTrailLevels64);
    if (settings.experiment.sah_costs) {
        config.method = SahBvhBuilder::Method::sweep;
        config.traversal_cost = settings.experiment.sah_costs->traversal;
        config.intersection_cost = settings.experiment.sah_costs->intersection;
        if (max_leaf_size > 1) config.max_leaf_size = kMostPolygonsOfALeaf;
    }
    return add_axes(SahBvhBuilder::build(boxes, config));
}

WalkTree make_tree(std::vector<Box> boxes, const RenderSettings& settings, TraversalKind traversal,
                   uint32_t max_leaf_size) {
    WalkTree tree;
    for (const Box& box : boxes) tree.bounds.extend(box);
    if (settings.experiment.structure == StructureKind::kdtree) {
        SahKdTreeBuilder::Config config;
        if (settings.experiment.sah_costs) {
            config.traversal_cost = settings.experiment.sah_costs->traversal;
            config.intersection_cost = settings.experiment.sah_costs->intersection;
        }
        if (traversal == TraversalKind::backtrack) config.cells = SahKdTreeBuilder::Cells::kept;
        tree.kd = SahKdTreeBuilder::build(boxes, config);
        tree.boxes = std::move(boxes);
        return tree;
    }
    const AxisBvh binary = build_binary(boxes, settings, max_leaf_size);
    if (traversal == TraversalKind::trail || traversal == TraversalKind::pair_trail) {
        tree.heap = make_succinct_heap(binary);
        return tree;
    }
    tree.linked = make_linked_bvh(binary);
    if (traversal != TraversalKind::parent_link) tree.linked.parents = {};
    if (traversal != TraversalKind::skip_link) tree.linked.skips = {};
    return tree;
}

} // namespace

size_t WalkTree::byte_count() const {
    return linked.byte_count() + (linked.parents.size() + linked.skips.size()) * sizeof(uint32_t) +
           heap.byte_count() + kd.byte_count() + boxes.size() * sizeof(Box);
}

size_t WalkTrees::byte_count() const {
    size_t bytes = instances.byte_count();
    for (const WalkTree& tree : surfaces) bytes += tree.byte_count();
    return bytes;
}

int WalkTree::depth() const { return std::max({linked.depth, heap.depth, kd.depth}); }

WalkTrees make_walk_trees(const PreparedScene& scene, const RenderSettings& settings, EngineKind engine) {
    WalkTrees trees;
    const TraversalKind traversal = trees.traversal = choose_traversal(settings, engine);
    std::vector<Box> bounds;
    for (const Surface& surface : scene.surfaces) {
        trees.surfaces.push_back(make_tree(compute_patch_boxes(surface), settings, traversal,
                                           surface.has_displacement ? 1 : kPolygonsOfALeaf));
        bounds.push_back(trees.surfaces.back().bounds);
        trees.depth = std::max(trees.depth, trees.surfaces.back().depth());
    }
    trees.instances = make_tree(compute_instance_boxes(scene, bounds), settings, traversal, 1);
    trees.depth = std::max(trees.depth, trees.instances.depth());
    return trees;
}

} // namespace relief
