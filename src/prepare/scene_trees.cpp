#include "prepare/scene_trees.h"

#include "base/parallel.h"
#include "bvh/sah_bvh.h"

namespace relief {

std::vector<Box> compute_patch_boxes(const Surface& surface) {
    std::vector<Box> boxes(surface.patch_count());
    parallel_for("patch_boxes", boxes.size(), 256, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) boxes[k] = compute_patch_box(surface, uint32_t(k));
    });
    return boxes;
}

std::vector<Box> compute_instance_boxes(const PreparedScene& scene, std::span<const Box> surface_boxes) {
    std::vector<Box> boxes;
    for (const Instance& instance : scene.instances) {
        const Box& box = surface_boxes[instance.surface];
        const Vec3f& place = instance.world_from_object.translation;
        boxes.push_back(box.is_empty() ? Box{place, place} : transform_box(instance.world_from_object, box));
    }
    return boxes;
}

Bvh build_surface_bvh(const Surface& surface, std::span<const Box> boxes) {
    SahBvhBuilder::Config config;
    config.max_leaf_size = surface.has_displacement ? 1 : 4;
    return SahBvhBuilder::build(boxes, config);
}

Bvh build_instance_bvh(const PreparedScene& scene, std::span<const Box> surface_boxes) {
    SahBvhBuilder::Config config;
    config.max_leaf_size = 1;
    return SahBvhBuilder::build(compute_instance_boxes(scene, surface_boxes), config);
}

} // namespace relief
