// The shaders of shaders/, compiled to SPIR-V when Relief is built (cmake/Shaders.cmake).
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace relief::vulkan {

/// SPIR-V of shaders/NAME.comp, .vert or .frag, or of a variant; empty if there is none.
std::span<const uint32_t> find_shader(std::string_view name);

} // namespace relief::vulkan
