// The shaders of lab/vulkan/shaders, compiled to SPIR-V when Relief is built (cmake/Shaders.cmake).
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lab/walks/trail.h"
#include "relief/traversal.h"
#include "vulkan/device/kernel.h"

namespace relief::vulkan {

namespace lab {

/// As vulkan::find_shader.
std::span<const uint32_t> find_shader(std::string_view name);

/// A kernel of one of these shaders; as KernelConfig.
inline Kernel make_kernel(const Device& device, const std::string& shader, std::vector<uint32_t> constants) {
    return Kernel(device, {shader, std::move(constants), find_shader(shader)});
}

} // namespace lab

/// The variant of a shader that walks trees of `depth` levels in that way: "scene_walk_skip_link". Those with
/// keys or trails come in two widths: "scene_walk_trail_64".
inline std::string name_walk(std::string_view shader, TraversalKind traversal, int depth) {
    std::string name = std::string(shader) + "_" + traversal_name(traversal);
    std::replace(name.begin(), name.end(), '-', '_');
    const bool has_widths = traversal == TraversalKind::restart_trail || traversal == TraversalKind::trail ||
                            traversal == TraversalKind::pair_trail;
    return has_widths ? name + (depth <= int(scalar::kTrailLevels32) ? "_32" : "_64") : name;
}

} // namespace relief::vulkan
