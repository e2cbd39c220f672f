// Meshes of a scene that are as they were before (SceneUpdate::scene).
#pragma once

#include "relief/scene.h"

namespace relief {

inline bool is_left_out(const Mesh& mesh) { return mesh.positions.empty() && mesh.face_sizes.empty(); }

/// As validate_scene(), for scenes whose left-out meshes are put back and looked at later.
void validate_without_left_out(const Scene& scene);

} // namespace relief
