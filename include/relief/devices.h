// The devices that the Vulkan engine could run on.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace relief {

struct DeviceInfo {
    int index = 0; ///< what DeviceSettings::index takes
    std::string name, driver;
    std::string kind;                 ///< "gpu", or "cpu" for a program that stands in for one
    uint64_t memory_bytes = 0;        ///< of its largest memory
    std::vector<std::string> missing; ///< what Relief needs and it lacks, by Vulkan's names; empty: usable
    std::vector<std::string> missing_to_draw; ///< and what the methods fragment and hybrid need beyond it
    std::vector<std::string> methods;         ///< render methods that it offers, the default first
};

/// All of them, in the order of their indices; empty without a driver and in builds without Vulkan.
std::vector<DeviceInfo> vulkan_devices();

} // namespace relief
