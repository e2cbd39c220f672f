// Vulkan objects behind Device, shared by all kernels and buffers. Included only by the implementations of
// device.h, buffer.h, kernel.h and commands.h, because Vulkan's headers are slow to compile.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include <vulkan/vulkan_raii.hpp>

#include "base/stop_request.h"
#include "vulkan/device/buffer.h"
#include "vulkan/device/device.h"
#include "vulkan/device/memory.h"
#include "vulkan/device/shared_device.h"

namespace relief::vulkan {

struct Device::Implementation {
    explicit Implementation(const Config& config);
    ~Implementation();

    /// Names an object for validation messages and debuggers.
    template <class Handle> void set_name(const Handle& handle, const std::string& name) const {
        shared->set_name(handle, name);
    }
    bool compiles_only() const { return shared->config.compiles_only; }
    /// Submits a recorded command buffer and waits. `describe` names its contents if the device is lost.
    void submit_and_wait(const vk::raii::CommandBuffer& commands,
                         const std::function<std::string()>& describe);
    /// Records with `record`, submits and waits; for copies.
    void run_once(const char* what, const std::function<void(const vk::raii::CommandBuffer&)>& record);
    void heed_stop() const {
        if (is_stop_asked_for && is_stop_asked_for()) throw StopRequest();
    }
    /// Staging memory of kStagingBytes, created on first use.
    Buffer::Implementation& staging();

    static constexpr uint64_t kStagingBytes = 16u << 20;

    std::shared_ptr<SharedDevice> shared;
    bool is_staged = false;
    vk::raii::CommandPool pool = nullptr;
    vk::raii::Fence fence = nullptr;
    std::unique_ptr<MemoryAllocator> memory; ///< null where the device compiles only
    std::unique_ptr<Buffer::Implementation> staging_buffer;
    std::function<bool()> is_stop_asked_for; ///< empty: never
};

struct Buffer::Implementation {
    Implementation(Device::Implementation& device, const BufferConfig& config);
    ~Implementation();

    bool holds_nothing() const { return !*buffer; } ///< on a device that compiles only

    Device::Implementation& device;
    BufferConfig config;
    vk::raii::Buffer buffer = nullptr;
    MemorySpan memory;
    vk::raii::BufferView texels = nullptr; ///< only with a format
};

/// Memory barrier between any two commands: shaders of these stages, transfer and indirect arguments.
void record_barrier(const vk::raii::CommandBuffer& commands,
                    vk::ShaderStageFlags shaders = vk::ShaderStageFlagBits::eCompute);
/// Makes device writes visible to the host after the fence.
void record_host_barrier(const vk::raii::CommandBuffer& commands, vk::ShaderStageFlags shaders);

} // namespace relief::vulkan
