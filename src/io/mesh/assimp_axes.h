// Axes and unit that an FBX file says it has.
#pragma once

#include <string>
#include <vector>

#include <assimp/matrix4x4.h>
#include <assimp/scene.h>

namespace relief {

/// Returns the turn that brings the up axis of the file to y and its front axis to z. Without axes, or where
/// two of them are one, it is the identity; the latter adds a warning after `name`.
aiMatrix4x4 find_turn_of_axes(const aiScene& scene, const std::string& name,
                              std::vector<std::string>& warnings);

/// Adds a warning where a unit of length is neither a centimetre nor a metre.
void warn_of_unit(const aiScene& scene, const std::string& name, std::vector<std::string>& warnings);

} // namespace relief
