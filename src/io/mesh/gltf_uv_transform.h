// KHR_texture_transform: where the textures of a material read the uvs of a mesh.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/mesh/gltf_file.h"

namespace relief {

/// Rows of an affine map of uvs whose v runs downwards: u' = [0] u + [1] v + [2], v' = [3] u + [4] v + [5].
using UvTransform = std::array<float, 6>;

/// What the textures of the material of a part have on one uv set, if all have the same; nothing where that
/// changes no uv, or no texture lies on the set. Where they differ, a warning is added. Throws bad_input.
std::optional<UvTransform> find_uv_transform(const GltfFile& file, const JsonNode& primitive, int uv_set,
                                             std::vector<std::string>& warnings);

/// Two numbers per uv.
std::vector<float> transform_uvs(std::span<const float> uvs, const UvTransform& transform);

} // namespace relief
