// The keys of a scene that moves.
#pragma once

#include <vector>

#include "io/scene/json_node.h"
#include "relief/scene.h"

namespace relief {

/// Throws Error{usage} where lists have other lengths than there are frames, or are of nothing in the scene.
void check_motion(const Scene& scene, const SceneMotion& motion);

/// The transform of an object; what never changes has no keys.
Json write_placements(const std::vector<SceneMotion::Placement>& placements, int first_frame);

/// The place and target of a camera.
void write_views(const SceneMotion& motion, Json& camera);

} // namespace relief
