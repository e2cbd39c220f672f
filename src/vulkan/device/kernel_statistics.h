// What a driver tells of the kernels that it has compiled (VK_KHR_pipeline_executable_properties).
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "vulkan/device/device.h"

namespace relief::vulkan {

/// Under the driver's own name, with its explanation.
struct KernelFigure {
    std::string name, description;
    std::variant<bool, int64_t, uint64_t, double> value;
};

/// A kernel may have several: one a stage, or one a width of subgroups.
struct KernelProgram {
    std::string name;
    uint32_t subgroup_size = 0; ///< 0: not one size
    std::vector<KernelFigure> figures;
};

struct KernelStatistics {
    std::string shader, vertex_shader; ///< as in KernelConfig
    std::vector<uint32_t> constants;   ///< those that the shader declares, given or its own; others 0
    std::vector<KernelProgram> programs;
};

/// Of all kernels made since the last call, in order. The device compiles only (Device::Config).
std::vector<KernelStatistics> take_kernel_statistics(const Device& device);

} // namespace relief::vulkan
