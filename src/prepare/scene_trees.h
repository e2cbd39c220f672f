// The two scene trees, over the patches of a surface and over the instances, as engines walk them by default.
#pragma once

#include <span>
#include <vector>

#include "bvh/bvh.h"
#include "prepare/prepared_scene.h"

namespace relief {

/// Boxes of the patches of a surface, in parallel.
std::vector<Box> compute_patch_boxes(const Surface& surface);

/// World boxes of instances, from those of patches by surface; a point where a surface has none.
std::vector<Box> compute_instance_boxes(const PreparedScene& scene, std::span<const Box> surface_boxes);

/// Over a surface's patches, in parallel: a leaf per displaced patch, shared leaves for polygons.
Bvh build_surface_bvh(const Surface& surface, std::span<const Box> boxes);

/// Over the instances, one a leaf; `surface_boxes` as above.
Bvh build_instance_bvh(const PreparedScene& scene, std::span<const Box> surface_boxes);

} // namespace relief
