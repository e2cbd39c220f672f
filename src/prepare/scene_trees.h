// The two scene trees, over the patches of a surface and over the instances, as engines walk them by default.
#pragma once

#include <span>
#include <vector>

#include "bvh/bvh.h"
#include "prepare/prepared_scene.h"

namespace relief {

/// Boxes of the patches of a surface, in parallel.
std::vector<Box> compute_patch_boxes(const Surface& surface);

/// Boxes of the instances in world space. `surface_boxes` hold the patches of each surface; where one is
/// empty, there is nothing to be seen, and a point stands for the instance.
std::vector<Box> compute_instance_boxes(const PreparedScene& scene, std::span<const Box> surface_boxes);

/// Over the patches of one surface, whose boxes are given, in parallel. Displaced patches are expensive to
/// intersect, so each has a leaf of its own; polygons share leaves.
Bvh build_surface_bvh(const Surface& surface, std::span<const Box> boxes);

/// Over the instances, one a leaf; `surface_boxes` as above.
Bvh build_instance_bvh(const PreparedScene& scene, std::span<const Box> surface_boxes);

} // namespace relief
