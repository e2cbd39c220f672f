// Compiled pipelines kept in a file between runs. Included by the files behind device.h only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <vulkan/vulkan_raii.hpp>

namespace relief::vulkan {

/// Bytes of a cache file if it was written for this device and driver; empty for any other file or none.
std::vector<uint8_t> read_pipeline_cache(const std::filesystem::path& path,
                                         const vk::PhysicalDeviceProperties& device);

/// Replaces the file in one step. A file that cannot be written is left as it was: the cache only saves time.
void write_pipeline_cache(const std::filesystem::path& path, const std::vector<uint8_t>& data) noexcept;

} // namespace relief::vulkan
