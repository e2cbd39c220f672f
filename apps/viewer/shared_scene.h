// A scene whose meshes are shared, so that a copy for another thread costs no geometry.
#pragma once

#include <memory>
#include <vector>

#include "relief/scene.h"

namespace relief::viewer {

using SharedMeshes = std::vector<std::shared_ptr<const Mesh>>;

struct SharedScene {
    Scene scene;         ///< without meshes
    SharedMeshes meshes; ///< of the scene
};

/// Copies of the meshes.
SharedMeshes share_meshes(const std::vector<Mesh>& meshes);

/// The scene with copies of its meshes.
Scene make_whole(const SharedScene& shared);
/// The same; meshes that are `before` under their numbers are left out, as SceneUpdate::scene has them.
Scene make_next(const SharedScene& shared, const SharedMeshes& before);

} // namespace relief::viewer
