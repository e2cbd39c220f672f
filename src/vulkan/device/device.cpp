#include "vulkan/device/device.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <thread>

#include <fmt/format.h>

#include "vulkan/device/device_internals.h"
#include "vulkan/device/errors.h"

namespace relief::vulkan {

namespace {

constexpr std::chrono::milliseconds kLongestSpin{2};

} // namespace

Device::Implementation::Implementation(const Config& config)
    : shared(share_device(config)), is_staged(config.is_staged) {
    if (config.compiles_only) return;
    check_vulkan("making the device", [&] {
        const vk::raii::Device& device = shared->device;
        pool = vk::raii::CommandPool(device, {vk::CommandPoolCreateFlagBits::eTransient, shared->family});
        set_name(pool, "relief copies");
        fence = vk::raii::Fence(device, vk::FenceCreateInfo());
        set_name(fence, "relief fence");
        memory = std::make_unique<MemoryAllocator>(shared->physical, device);
    });
}

Device::Implementation::~Implementation() { shared->save_pipelines(); }

void Device::Implementation::submit_and_wait(const vk::raii::CommandBuffer& commands,
                                             const std::function<std::string()>& describe) {
    try {
        const vk::CommandBufferSubmitInfo part(*commands);
        {
            const std::lock_guard lock(shared->queue_mutex);
            shared->queue.submit2(vk::SubmitInfo2({}, {}, part, {}), *fence);
        }
        // Interrupts take longer than most launches of a GPU; a CPU device needs the core.
        const auto begin = std::chrono::steady_clock::now();
        while (!shared->description.is_cpu && fence.getStatus() == vk::Result::eNotReady &&
               std::chrono::steady_clock::now() - begin < kLongestSpin)
            std::this_thread::yield();
        const uint64_t forever = std::numeric_limits<uint64_t>::max();
        static_cast<void>(shared->device.waitForFences(*fence, true, forever));
        shared->device.resetFences(*fence);
    } catch (const vk::SystemError& error) {
        if (error.code().value() == int(vk::Result::eErrorDeviceLost)) shared->is_lost = true;
        throw_vulkan_error(fmt::format("{} on {}", describe(), shared->description.name), error);
    }
}

void Device::Implementation::run_once(const char* what,
                                      const std::function<void(const vk::raii::CommandBuffer&)>& record) {
    check_vulkan(what, [&] {
        const vk::raii::CommandBuffers buffers(shared->device, {*pool, vk::CommandBufferLevel::ePrimary, 1});
        const vk::raii::CommandBuffer& commands = buffers.front();
        set_name(commands, what);
        commands.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
        record_barrier(commands, shared->shader_stages);
        record(commands);
        record_host_barrier(commands, shared->shader_stages);
        commands.end();
        submit_and_wait(commands, [what] { return std::string(what); });
    });
}

Buffer::Implementation& Device::Implementation::staging() {
    if (!staging_buffer)
        staging_buffer =
            std::make_unique<Buffer::Implementation>(*this, BufferConfig{.name = "staging",
                                                                         .bytes = kStagingBytes,
                                                                         .purpose = Purpose::staging,
                                                                         .is_host_visible = true});
    return *staging_buffer;
}

Device::StopScope::StopScope(const Device& device, std::function<bool()> is_asked_for) : device_(device) {
    device_.internals().is_stop_asked_for = std::move(is_asked_for);
}
Device::StopScope::~StopScope() { device_.internals().is_stop_asked_for = nullptr; }

Device::Device(const Config& config) : implementation_(std::make_unique<Implementation>(config)) {}
Device::~Device() = default;

const DeviceDescription& Device::description() const { return implementation_->shared->description; }
uint64_t Device::max_buffer_bytes() const { return implementation_->shared->max_buffer_bytes; }
uint64_t Device::max_texel_count() const { return implementation_->shared->limits.maxTexelBufferElements; }
uint32_t Device::max_group_size() const {
    const vk::PhysicalDeviceLimits& limits = implementation_->shared->limits;
    return std::min(limits.maxComputeWorkGroupInvocations, limits.maxComputeWorkGroupSize[0]);
}
uint32_t Device::resident_group_count() const { return implementation_->shared->resident_group_count; }
RenderMethod Device::method() const { return implementation_->shared->config.method; }
uint32_t Device::max_draw_size() const {
    const vk::PhysicalDeviceLimits& limits = implementation_->shared->limits;
    return std::min({limits.maxFramebufferWidth, limits.maxFramebufferHeight, limits.maxViewportDimensions[0],
                     limits.maxViewportDimensions[1]});
}
uint64_t Device::available_bytes() const {
    return implementation_->memory ? implementation_->memory->available_bytes() : max_buffer_bytes();
}
uint64_t Device::held_bytes() const {
    return implementation_->memory ? implementation_->memory->held_bytes() : 0;
}
uint64_t Device::allocated_bytes(Purpose purpose) const {
    return implementation_->memory ? implementation_->memory->allocated_bytes(purpose) : 0;
}
uint64_t Device::peak_bytes(Purpose purpose) const {
    return implementation_->memory ? implementation_->memory->peak_bytes(purpose) : 0;
}

std::vector<std::string> Device::validation_messages() const {
    const MessageLog* messages = implementation_->shared->messages.get();
    return messages ? messages->copy() : std::vector<std::string>();
}

} // namespace relief::vulkan
