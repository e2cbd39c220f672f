// What a scene's hash says of its meshes and pictures.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "base/content_hash.h"
#include "relief/scene.h"

namespace relief {

/// Adds the meshes, the numbers of map tiles, and the size and texels of every texture of a scene once.
void add_scene_content(ContentHash& hash, const Scene& scene);

/// The same for a scene that changes: what is as it was is not looked at again.
class SceneContent {
  public:
    /// Meshes without faces are as they were.
    void add_to(ContentHash& hash, const Scene& scene);
    /// What add_to() has for a mesh without faces.
    void set_mesh(size_t index, uint64_t hash);

  private:
    uint64_t find_hash(const std::shared_ptr<const Texture>& texture);

    std::vector<uint64_t> meshes_;
    std::map<std::weak_ptr<const Texture>, uint64_t, std::owner_less<>> textures_;
};

} // namespace relief
