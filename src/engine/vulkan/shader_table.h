// The shaders of shaders/, compiled to SPIR-V when Relief is built (cmake/Shaders.cmake).
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "relief/traversal.h"

namespace relief::vulkan {

/// SPIR-V of shaders/NAME.comp, .vert or .frag, or of a variant of one; empty when there is none.
std::span<const uint32_t> find_shader(std::string_view name);

/// The variant of a shader that walks in that way: "scene_walk_skip_link".
inline std::string name_walk(std::string_view shader, TraversalKind traversal) {
    std::string name = std::string(shader) + "_" + traversal_name(traversal);
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

} // namespace relief::vulkan
