// The shaders of tests/vulkan/shaders, compiled to SPIR-V when the tests are built.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "vulkan/device/kernel.h"

namespace relief::vulkan::tests {

/// SPIR-V of shaders/NAME.comp; empty when there is none.
std::span<const uint32_t> find_shader(std::string_view name);

/// Kernel of a test shader.
inline Kernel make_test_kernel(const Device& device, const std::string& name,
                               std::vector<uint32_t> constants = {64}) {
    return Kernel(device, {name, std::move(constants), find_shader(name)});
}

} // namespace relief::vulkan::tests
