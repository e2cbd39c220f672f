// KHR_texture_transform: the map that the textures of a material apply to the uvs of a mesh.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "io/mesh/gltf_file.h"

namespace relief {

/// Rows of an affine map of uvs whose v runs downwards: u' = [0] u + [1] v + [2], v' = [3] u + [4] v + [5].
using UvTransform = std::array<float, 6>;

/// Finds the transforms of the materials of one file; each material is looked at once per uv set.
class GltfUvTransforms {
  public:
    explicit GltfUvTransforms(const GltfFile& file) : file_(file) {}

    /// Returns the transform that all textures of a part's material have on one uv set; nothing where they
    /// differ, where it changes no uv, and where no texture uses the set. Throws bad_input.
    std::optional<UvTransform> find(const JsonNode& primitive, int uv_set);
    /// Counts the materials whose textures differ.
    std::vector<std::string> list_warnings() const;

  private:
    struct Mixed {
        size_t materials;
        std::string first;
    };
    std::optional<UvTransform> find_common(const JsonNode& material, int uv_set);

    const GltfFile& file_;
    std::optional<std::vector<JsonNode>> materials_;
    std::map<std::pair<const JsonNode*, int>, std::optional<UvTransform>> found_; ///< by material and uv set
    std::map<int, Mixed> mixed_;                                                  ///< by uv set
};

/// Two numbers per uv.
std::vector<float> transform_uvs(std::span<const float> uvs, const UvTransform& transform);

} // namespace relief
