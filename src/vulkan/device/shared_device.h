// What all Devices of one physical device and method share, so that a second engine of a process does not
// compile its kernels again. Part of device_internals.h.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <vulkan/vulkan_raii.hpp>

#include "vulkan/device/device.h"
#include "vulkan/device/instance.h"
#include "vulkan/device/pipeline_store.h"

namespace relief::vulkan {

/// A kernel that was made, with the constants as its shader sees them.
struct CompiledKernel {
    std::string shader, vertex_shader;
    std::vector<uint32_t> constants;
    std::shared_ptr<const vk::raii::Pipeline> pipeline;
};

/// A logical device with its queue, layouts and pipelines. Immutable but for the pipelines; `queue` is used
/// under `queue_mutex`.
struct SharedDevice {
    /// Throws as Device does.
    explicit SharedDevice(const Device::Config& config);

    template <class Handle> void set_name(const Handle& handle, const std::string& name) const {
        if (!instance.has_debug_names) return;
        const auto plain = static_cast<typename Handle::CType>(*handle);
        device.setDebugUtilsObjectNameEXT(
            {Handle::objectType, reinterpret_cast<uint64_t>(plain), name.c_str()});
    }
    /// Writes the pipelines to the cache file if there are new ones; without an error where that fails.
    void save_pipelines();

    Device::Config config;
    std::unique_ptr<MessageLog> messages; ///< null without validation
    Instance instance;
    vk::raii::PhysicalDevice physical = nullptr;
    DeviceDescription description;
    vk::PhysicalDeviceLimits limits;
    uint64_t max_buffer_bytes = 0;     ///< as a storage buffer
    uint64_t max_allocation_bytes = 0; ///< of a buffer of any kind
    uint32_t resident_group_count = 0;
    float timestamp_period_s = 0; ///< 0: the queue has none
    uint64_t timestamp_mask = 0;  ///< valid bits of a timestamp
    uint32_t family = 0;
    vk::ShaderStageFlags shader_stages = vk::ShaderStageFlagBits::eCompute; ///< available to kernels
    vk::raii::Device device = nullptr;
    vk::raii::Queue queue = nullptr;
    std::mutex queue_mutex;
    std::atomic<bool> is_lost = false;
    vk::raii::PipelineCache pipeline_cache = nullptr;
    std::mutex file_mutex;
    size_t bytes_in_file = 0; ///< of the pipeline cache; under file_mutex
    vk::raii::DescriptorSetLayout set_layout = nullptr;
    vk::raii::PipelineLayout pipeline_layout = nullptr;
    PipelineStore<vk::raii::Pipeline> pipelines;
    std::vector<CompiledKernel> compiled; ///< of a device that compiles only: kernels not reported yet
};

/// The device of this configuration that the process has already, or a new one: without Config::is_shared,
/// and where the last one was lost. Shared ones stay until the process ends, and their validation messages
/// are those of all who share. Thread safe. Throws as Device does.
std::shared_ptr<SharedDevice> share_device(const Device::Config& config);

} // namespace relief::vulkan
