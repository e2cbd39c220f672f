#include "vulkan/device/device.h"

#include <algorithm>
#include <array>
#include <limits>
#include <thread>

#include <fmt/format.h>

#include "vulkan/device/device_internals.h"
#include "vulkan/device/errors.h"
#include "vulkan/device/pipeline_cache.h"
#include "vulkan/layout/bindings.h"

namespace relief::vulkan {
namespace {

[[noreturn]] void refuse_device(std::string message, std::string hint) {
    throw Error(ErrorKind::device_missing, {std::move(message), "Vulkan", std::move(hint)});
}

void require_usable(const DeviceDescription& device) {
    if (device.missing.empty()) return;
    refuse_device(
        fmt::format("device {} ({}) lacks {}", device.index, device.name, fmt::join(device.missing, ", ")),
        "update its driver, choose another with device.index, or use device.engine = cpu");
}

/// Discrete GPUs first, then integrated ones, software implementations last.
int rank_type(vk::PhysicalDeviceType type) {
    switch (type) {
    case vk::PhysicalDeviceType::eDiscreteGpu:
        return 0;
    case vk::PhysicalDeviceType::eIntegratedGpu:
        return 1;
    case vk::PhysicalDeviceType::eCpu:
        return 3;
    default:
        return 2;
    }
}

void require_drawing(const DeviceDescription& device, RenderMethod method) {
    if (method == RenderMethod::compute || device.missing_to_draw.empty()) return;
    refuse_device(fmt::format("device {} ({}) lacks {} for this method", device.index, device.name,
                              fmt::join(device.missing_to_draw, ", ")),
                  "use experiment.method = compute, or choose another device with device.index");
}

vk::raii::PhysicalDevice choose_device(const vk::raii::Instance& instance, const Device::Config& config,
                                       DeviceDescription& description) {
    const int index = config.index;
    vk::raii::PhysicalDevices devices(instance);
    if (devices.empty())
        refuse_device("there is no Vulkan device", "install a driver for it, or use device.engine = cpu");
    if (index >= int(devices.size()))
        refuse_device(fmt::format("there is no device {}", index),
                      fmt::format("vulkan_devices() lists them, 0 to {}", devices.size() - 1));
    size_t chosen = size_t(std::max(index, 0));
    if (index < 0) {
        const auto rank = [&](size_t i) {
            const DeviceDescription device = describe_device(devices[i], uint32_t(i));
            const bool is_usable = device.missing.empty() &&
                                   (config.method == RenderMethod::compute || device.missing_to_draw.empty());
            return std::pair(!is_usable, rank_type(devices[i].getProperties().deviceType));
        };
        for (size_t i = 1; i < devices.size(); ++i)
            if (rank(i) < rank(chosen)) chosen = i;
    }
    description = describe_device(devices[chosen], uint32_t(chosen));
    require_usable(description);
    require_drawing(description, config.method);
    return std::move(devices[chosen]);
}

/// Resident groups of 256 invocations; if the driver does not report it, enough for a large device.
uint32_t count_resident_groups(const vk::raii::PhysicalDevice& device, bool is_cpu) {
    constexpr uint32_t kGroupsPerUnit = 8;
    constexpr uint32_t kUnitsOfALargeGpu = 128;
    if (is_cpu) return std::max(1u, std::thread::hardware_concurrency()) * kGroupsPerUnit;
    if (has_extension(device, VK_NV_SHADER_SM_BUILTINS_EXTENSION_NAME)) {
        const auto chain = device.getProperties2<vk::PhysicalDeviceProperties2,
                                                 vk::PhysicalDeviceShaderSMBuiltinsPropertiesNV>();
        return chain.get<vk::PhysicalDeviceShaderSMBuiltinsPropertiesNV>().shaderSMCount * kGroupsPerUnit;
    }
    if (has_extension(device, VK_AMD_SHADER_CORE_PROPERTIES_EXTENSION_NAME)) {
        const auto chain =
            device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceShaderCorePropertiesAMD>();
        const auto& core = chain.get<vk::PhysicalDeviceShaderCorePropertiesAMD>();
        return core.shaderEngineCount * core.shaderArraysPerEngineCount * core.computeUnitsPerShaderArray *
               kGroupsPerUnit;
    }
    return kUnitsOfALargeGpu * kGroupsPerUnit;
}

void read_limits(Device::Implementation& d) {
    const auto chain =
        d.physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan11Properties,
                                  vk::PhysicalDeviceVulkan13Properties>();
    const auto& with_11 = chain.get<vk::PhysicalDeviceVulkan11Properties>();
    d.limits = chain.get<vk::PhysicalDeviceProperties2>().properties.limits;
    d.max_allocation_bytes = std::min<uint64_t>(
        with_11.maxMemoryAllocationSize, chain.get<vk::PhysicalDeviceVulkan13Properties>().maxBufferSize);
    d.max_buffer_bytes = std::min<uint64_t>(d.limits.maxStorageBufferRange, d.max_allocation_bytes);
    d.resident_group_count = count_resident_groups(d.physical, d.description.is_cpu);
    if (d.config.method == RenderMethod::compute) {
        d.family = find_compute_family(d.physical).value();
    } else {
        d.family = find_drawing_family(d.physical).value();
        d.shader_stages |= vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment;
    }
    const uint32_t timestamp_bits = d.physical.getQueueFamilyProperties()[d.family].timestampValidBits;
    d.timestamp_period_s = timestamp_bits > 0 ? d.limits.timestampPeriod * 1e-9f : 0.0f;
    d.timestamp_mask = timestamp_bits < 64 ? (uint64_t(1) << timestamp_bits) - 1 : ~uint64_t(0);
}

vk::raii::Device make_device(const Device::Implementation& d) {
    vk::PhysicalDeviceVulkan13Features with_13;
    const bool is_drawing = d.config.method != RenderMethod::compute;
    with_13.synchronization2 = with_13.maintenance4 = true;
    with_13.dynamicRendering = is_drawing;
    vk::PhysicalDeviceVulkan12Features with_12;
    with_12.shaderBufferInt64Atomics = with_12.scalarBlockLayout = with_12.hostQueryReset = true;
    with_12.pNext = &with_13;
    vk::PhysicalDeviceFeatures2 features;
    features.features.shaderInt64 = true;
    features.features.fragmentStoresAndAtomics = features.features.largePoints = is_drawing;
    features.pNext = &with_12;
    const std::array priority = {1.0f};
    const vk::DeviceQueueCreateInfo queue({}, d.family, priority);
    std::vector<const char*> extensions;
    if (has_extension(d.physical, VK_EXT_MEMORY_BUDGET_EXTENSION_NAME))
        extensions.push_back(VK_EXT_MEMORY_BUDGET_EXTENSION_NAME);
    return {d.physical, vk::DeviceCreateInfo({}, queue, {}, extensions, nullptr, &features)};
}

vk::raii::DescriptorSetLayout make_set_layout(const Device::Implementation& d) {
    std::vector<vk::DescriptorSetLayoutBinding> bindings;
    const auto add = [&](uint32_t first, uint32_t count, vk::DescriptorType type) {
        for (uint32_t i = 0; i < count; ++i) bindings.emplace_back(first + i, type, 1, d.shader_stages);
    };
    add(0, scalar::kStorageBindingCount, vk::DescriptorType::eStorageBuffer);
    add(scalar::kFirstTexelBinding, scalar::kTexelBindingCount, vk::DescriptorType::eUniformTexelBuffer);
    return {d.device, vk::DescriptorSetLayoutCreateInfo({}, bindings)};
}

void make_shared_objects(Device::Implementation& d) {
    d.queue = vk::raii::Queue(d.device, d.family, 0);
    d.set_name(d.queue, "relief queue");
    d.set_layout = make_set_layout(d);
    d.set_name(d.set_layout, "relief bindings");
    const vk::PushConstantRange push(d.shader_stages, 0, scalar::kMaxPushBytes);
    d.pipeline_layout =
        vk::raii::PipelineLayout(d.device, vk::PipelineLayoutCreateInfo({}, *d.set_layout, push));
    d.set_name(d.pipeline_layout, "relief pipeline layout");
    d.pool = vk::raii::CommandPool(d.device, {vk::CommandPoolCreateFlagBits::eTransient, d.family});
    d.set_name(d.pool, "relief copies");
    d.fence = vk::raii::Fence(d.device, vk::FenceCreateInfo());
    d.set_name(d.fence, "relief fence");

    std::vector<uint8_t> cached;
    if (!d.config.pipeline_cache.empty())
        cached = read_pipeline_cache(d.config.pipeline_cache, d.physical.getProperties());
    d.loaded_cache_bytes = cached.size();
    d.pipeline_cache =
        vk::raii::PipelineCache(d.device, vk::PipelineCacheCreateInfo({}, cached.size(), cached.data()));
    d.set_name(d.pipeline_cache, "relief pipeline cache");
}

void save_pipeline_cache(const Device::Implementation& d) {
    if (d.config.pipeline_cache.empty()) return;
    try {
        const std::vector<uint8_t> data = d.pipeline_cache.getData();
        if (data.size() != d.loaded_cache_bytes) write_pipeline_cache(d.config.pipeline_cache, data);
    } catch (const vk::SystemError&) {
        // Saving fails on a lost device; the next run compiles the pipelines again.
    }
}

} // namespace

Device::Implementation::Implementation(const Config& wanted)
    : config(wanted),
      messages(wanted.is_validated ? std::make_unique<MessageLog>() : nullptr),
      instance(make_instance(messages.get())) {
    check_vulkan("making the device", [&] {
        physical = choose_device(instance.handle, config, description);
        read_limits(*this);
        device = make_device(*this);
        set_name(device, "relief device");
        make_shared_objects(*this);
        memory = std::make_unique<MemoryAllocator>(physical, device);
    });
}

Device::Implementation::~Implementation() {
    save_pipeline_cache(*this);
    staging_buffer.reset();
}

void Device::Implementation::submit_and_wait(const vk::raii::CommandBuffer& commands,
                                             const std::function<std::string()>& describe) {
    try {
        const vk::CommandBufferSubmitInfo part(*commands);
        queue.submit2(vk::SubmitInfo2({}, {}, part, {}), *fence);
        const uint64_t forever = std::numeric_limits<uint64_t>::max();
        static_cast<void>(device.waitForFences(*fence, true, forever));
        device.resetFences(*fence);
    } catch (const vk::SystemError& error) {
        throw_vulkan_error(fmt::format("{} on {}", describe(), description.name), error);
    }
}

void Device::Implementation::run_once(const char* what,
                                      const std::function<void(const vk::raii::CommandBuffer&)>& record) {
    check_vulkan(what, [&] {
        const vk::raii::CommandBuffers buffers(device, {*pool, vk::CommandBufferLevel::ePrimary, 1});
        const vk::raii::CommandBuffer& commands = buffers.front();
        set_name(commands, what);
        commands.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
        record_barrier(commands, shader_stages);
        record(commands);
        record_host_barrier(commands, shader_stages);
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

const DeviceDescription& Device::description() const { return implementation_->description; }
uint64_t Device::max_buffer_bytes() const { return implementation_->max_buffer_bytes; }
uint64_t Device::max_texel_count() const { return implementation_->limits.maxTexelBufferElements; }
uint32_t Device::max_group_size() const {
    const vk::PhysicalDeviceLimits& limits = implementation_->limits;
    return std::min(limits.maxComputeWorkGroupInvocations, limits.maxComputeWorkGroupSize[0]);
}
uint32_t Device::resident_group_count() const { return implementation_->resident_group_count; }
RenderMethod Device::method() const { return implementation_->config.method; }
uint32_t Device::max_draw_size() const {
    const vk::PhysicalDeviceLimits& limits = implementation_->limits;
    return std::min({limits.maxFramebufferWidth, limits.maxFramebufferHeight, limits.maxViewportDimensions[0],
                     limits.maxViewportDimensions[1]});
}
uint64_t Device::available_bytes() const { return implementation_->memory->available_bytes(); }
uint64_t Device::allocated_bytes(Purpose purpose) const {
    return implementation_->memory->allocated_bytes(purpose);
}
uint64_t Device::peak_bytes(Purpose purpose) const { return implementation_->memory->peak_bytes(purpose); }

std::vector<std::string> Device::validation_messages() const {
    return implementation_->messages ? implementation_->messages->copy() : std::vector<std::string>();
}

} // namespace relief::vulkan
