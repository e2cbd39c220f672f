// Devices available to the Vulkan engine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace relief {

struct DeviceInfo {
    int index = 0; ///< value for DeviceSettings::index
    std::string name, driver;
    std::string kind;          ///< "gpu", or "cpu" for a software implementation
    uint64_t memory_bytes = 0; ///< size of its largest memory heap
    std::vector<std::string>
        missing; ///< required features and limits it lacks, by Vulkan name; empty: usable
    std::vector<std::string> missing_to_draw; ///< further ones that fragment and hybrid require
    std::vector<std::string> methods;         ///< supported render methods, the default first
};

/// All devices in the order of their indices; empty without a driver and in builds without Vulkan.
std::vector<DeviceInfo> vulkan_devices();

} // namespace relief
