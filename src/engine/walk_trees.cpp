#include "engine/walk_trees.h"

#include <utility>

#include "base/parallel.h"
#include "structures/lbvh.h"
#include "structures/sah_bvh.h"

namespace relief {

namespace {

constexpr uint32_t kPolygonsOfALeaf = 4;

Lbvh build_binary(std::span<const Box> boxes, StructureKind structure, uint32_t max_leaf_size) {
    if (structure == StructureKind::lbvh) {
        LbvhBuilder::Config config;
        config.max_leaf_size = max_leaf_size;
        return LbvhBuilder::build(boxes, config);
    }
    SahBvhBuilder::Config config;
    config.max_leaf_size = max_leaf_size;
    config.max_depth = int(scalar::kTrailLevels32);
    Bvh bvh = SahBvhBuilder::build(boxes, config);
    std::vector<uint8_t> axes = compute_axes(bvh);
    return {std::move(bvh), std::move(axes)};
}

WalkTree make_tree(std::span<const Box> boxes, StructureKind structure, TraversalKind traversal,
                   uint32_t max_leaf_size) {
    WalkTree tree;
    for (const Box& box : boxes) tree.bounds.extend(box);
    if (structure == StructureKind::kdtree) {
        SahKdTreeBuilder::Config config;
        if (traversal == TraversalKind::backtrack) config.cells = SahKdTreeBuilder::Cells::kept;
        tree.kd = SahKdTreeBuilder::build(boxes, config);
        tree.boxes.assign(boxes.begin(), boxes.end());
        return tree;
    }
    Lbvh binary = build_binary(boxes, structure, max_leaf_size);
    if (compute_depth(binary.bvh) > int(scalar::kTrailLevels32)) {
        binary.bvh = limit_depth(binary.bvh, int(scalar::kTrailLevels32));
        binary.axes = compute_axes(binary.bvh);
    }
    if (traversal == TraversalKind::trail || traversal == TraversalKind::pair_trail)
        tree.heap = make_succinct_heap(binary.bvh, binary.axes);
    else
        tree.linked = make_linked_bvh(binary.bvh, binary.axes);
    return tree;
}

} // namespace

size_t WalkTree::byte_count(TraversalKind traversal) const {
    const size_t links = (traversal == TraversalKind::parent_link || traversal == TraversalKind::skip_link)
                             ? linked.nodes.size() * sizeof(uint32_t)
                             : 0;
    return linked.byte_count() + links + heap.byte_count() + kd.byte_count();
}

size_t WalkTrees::byte_count() const {
    size_t bytes = instances.byte_count(traversal);
    for (const WalkTree& tree : surfaces) bytes += tree.byte_count(traversal);
    return bytes;
}

std::vector<Box> compute_patch_boxes(const Surface& surface) {
    std::vector<Box> boxes(surface.patch_count());
    parallel_for("patch_boxes", boxes.size(), 256, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) boxes[k] = compute_patch_box(surface, uint32_t(k));
    });
    return boxes;
}

WalkTrees make_walk_trees(const PreparedScene& scene, StructureKind structure, TraversalKind traversal) {
    WalkTrees trees;
    trees.traversal = traversal;
    for (const Surface& surface : scene.surfaces)
        trees.surfaces.push_back(make_tree(compute_patch_boxes(surface), structure, traversal,
                                           surface.has_displacement ? 1 : kPolygonsOfALeaf));
    std::vector<Box> boxes;
    for (const Instance& instance : scene.instances) {
        const Box& bounds = trees.surfaces[instance.surface].bounds;
        // A place without a size stands for what has nothing to be seen.
        const Vec3f& place = instance.world_from_object.translation;
        boxes.push_back(bounds.is_empty() ? Box{place, place}
                                          : transform_box(instance.world_from_object, bounds));
    }
    trees.instances = make_tree(boxes, structure, traversal, 1);
    return trees;
}

} // namespace relief
