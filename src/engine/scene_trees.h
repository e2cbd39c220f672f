// The two upper trees, over the patches of a surface and over the instances: the same for every engine.
#pragma once

#include "engine/prepared_scene.h"
#include "structures/bvh.h"

namespace relief {

/// Over the patches of one surface, in parallel. Displaced patches are dear to enter, so each has a leaf of
/// its own; polygons share leaves.
Bvh build_surface_bvh(const Surface& surface);

/// Over the instances, one a leaf; `surface_boxes` hold the patches of each surface, empty boxes for surfaces
/// without any.
Bvh build_instance_bvh(const PreparedScene& scene, std::span<const Box> surface_boxes);

/// Edges on the longest way from the root to a leaf.
uint32_t measure_depth(const Bvh& bvh);

} // namespace relief
