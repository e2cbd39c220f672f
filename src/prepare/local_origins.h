// What lies far from the origin of its space is measured from a point nearby, so that digits are left for
// what it looks like: docs/decisions/local-origins.md.
#pragma once

#include <span>
#include <vector>

#include "prepare/prepared_scene.h"

namespace relief {

/// Moves meshes that lie far from the origin of their objects there, without rounding; returns what was taken
/// off each. `is_kept`: a byte a mesh, of those that are left as they are.
std::vector<Vec3f> move_meshes_to_origin(Scene& scene, std::span<const uint8_t> is_kept);

/// Transforms and reach of all instances, once their surfaces are made, and the origin of the scene.
/// `taken_off`: of the meshes.
void place_instances(const Scene& scene, std::span<const Vec3f> taken_off, SceneOrigin origin,
                     PreparedScene& prepared);

/// After an edit of its map; whether the reach of an instance has changed.
bool update_reach(PreparedScene& scene, uint32_t surface);

} // namespace relief
