// Trees of a named traversal on the device: nodes among the nodes, all else as words among the primitive ids,
// led by the records (WalkTreeData) of the instances and each surface.
#include "lab/scene_walks.h"
#include "formulas/tree.h"
#include "vulkan/layout/device_scene.h"

#include <cstring>

#include "lab/vulkan/lab_shaders.h"
#include "lab/walk_trees.h"
#include "prepare/traversals.h"

namespace relief::vulkan {

namespace {

using scalar::WalkTreeData;
static_assert(sizeof(WalkTreeData) == scalar::kWalkTreeWords * sizeof(uint32_t));
static_assert(sizeof(scalar::KdBox) == sizeof(NodeTexels) && sizeof(TreeNode) == sizeof(NodeTexels));

/// Copies anything made of units to the end; returns its first unit.
template <class T, class Unit> uint32_t append(const std::vector<T>& values, std::vector<Unit>& units) {
    static_assert(sizeof(T) % sizeof(Unit) == 0);
    const size_t first = units.size();
    units.resize(first + values.size() * sizeof(T) / sizeof(Unit));
    if (!values.empty()) std::memcpy(units.data() + first, values.data(), values.size() * sizeof(T));
    return uint32_t(first);
}

uint32_t append_boxes(const std::vector<Box>& boxes, std::vector<NodeTexels>& nodes) {
    const uint32_t first = uint32_t(nodes.size());
    for (const Box& box : boxes) nodes.push_back({box.lower, 0, box.upper, 0});
    return first;
}

WalkTreeData append_tree(const WalkTree& tree, TraversalKind traversal, std::vector<NodeTexels>& nodes,
                         std::vector<uint32_t>& words) {
    WalkTreeData data{};
    data.is_empty = tree.bounds.is_empty();
    if (data.is_empty) return data;
    switch (traversal) {
    case TraversalKind::trail:
    case TraversalKind::pair_trail:
        data.nodes = append(tree.heap.nodes, nodes);
        data.ids = append(tree.heap.primitive_ids, words);
        data.links = append(tree.heap.blocks, words);
        data.bricks = append(tree.heap.bricks, words);
        data.flat_levels = tree.heap.form.flat_levels, data.flat_pairs = tree.heap.form.flat_pairs;
        break;
    case TraversalKind::restart:
    case TraversalKind::push_down:
    case TraversalKind::backtrack:
        data.lower = tree.kd.bounds.lower, data.upper = tree.kd.bounds.upper;
        data.nodes = append(tree.kd.cells, nodes);
        data.ids = append(tree.kd.primitive_ids, words);
        data.links = append(tree.kd.nodes, words);
        data.boxes = append_boxes(tree.boxes, nodes);
        break;
    default:
        data.nodes = append(tree.linked.nodes, nodes);
        data.ids = append(tree.linked.primitive_ids, words);
        if (traversal == TraversalKind::parent_link) data.links = append(tree.linked.parents, words);
        if (traversal == TraversalKind::skip_link) data.links = append(tree.linked.skips, words);
    }
    return data;
}

} // namespace

TraversalKernel find_walk_kernel(TraversalKind traversal, int depth) {
    const std::string shader = name_walk("scene_walk", traversal, depth);
    return {shader, lab::find_shader(shader), lab::find_shader(shader + "_fragment")};
}

std::optional<SceneWalk> make_device_walk(const PreparedScene& scene, const RenderSettings& settings) {
    if (is_default_traversal(settings, EngineKind::vulkan)) return {};
    const WalkTrees trees = make_walk_trees(scene, settings, EngineKind::vulkan);
    SceneWalk walk;
    std::vector<WalkTreeData> records(1 + trees.surfaces.size());
    append(records, walk.words); // their place; filled in below
    for (size_t s = 0; s < trees.surfaces.size(); ++s) {
        records[1 + s] = append_tree(trees.surfaces[s], trees.traversal, walk.nodes, walk.words);
        walk.has_patches.push_back(!trees.surfaces[s].bounds.is_empty());
    }
    records[0] = append_tree(trees.instances, trees.traversal, walk.nodes, walk.words);
    walk.has_instances = !trees.instances.bounds.is_empty();
    std::memcpy(walk.words.data(), records.data(), records.size() * sizeof(WalkTreeData));
    walk.kernel = find_walk_kernel(trees.traversal, trees.depth);
    return walk;
}

} // namespace relief::vulkan
