#include "engine/scene_trees.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "engine/walk_trees.h"
#include "structures/sah_bvh.h"

namespace relief {

Bvh build_surface_bvh(const Surface& surface) {
    const std::vector<Box> boxes = compute_patch_boxes(surface);
    SahBvhBuilder::Config config;
    config.max_leaf_size = surface.has_displacement ? 1 : 4;
    return SahBvhBuilder::build(boxes, config);
}

Bvh build_instance_bvh(const PreparedScene& scene, std::span<const Box> surface_boxes) {
    std::vector<Box> boxes;
    for (const Instance& instance : scene.instances)
        boxes.push_back(transform_box(instance.world_from_object, surface_boxes[instance.surface]));
    SahBvhBuilder::Config config;
    config.max_leaf_size = 1;
    return SahBvhBuilder::build(boxes, config);
}

uint32_t measure_depth(const Bvh& bvh) {
    uint32_t deepest = 0;
    std::vector<std::pair<uint32_t, uint32_t>> open; // node, depth
    if (!bvh.nodes.empty()) open.emplace_back(0, 0);
    while (!open.empty()) {
        const auto [index, depth] = open.back();
        open.pop_back();
        deepest = std::max(deepest, depth);
        const BvhNode& node = bvh.nodes[index];
        if (node.is_leaf()) continue;
        open.emplace_back(node.first, depth + 1);
        open.emplace_back(node.first + 1, depth + 1);
    }
    return deepest;
}

} // namespace relief
