// Compiled pipelines stored in a file between runs. Included by the implementation of device.h only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <vulkan/vulkan_raii.hpp>

namespace relief::vulkan {

/// Contents of a cache file written for this device and driver; empty for any other or missing file.
std::vector<uint8_t> read_pipeline_cache(const std::filesystem::path& path,
                                         const vk::PhysicalDeviceProperties& device);

/// Replaces the file atomically, or leaves it as it is without an error: the cache only saves time.
void write_pipeline_cache(const std::filesystem::path& path, const std::vector<uint8_t>& data) noexcept;

} // namespace relief::vulkan
