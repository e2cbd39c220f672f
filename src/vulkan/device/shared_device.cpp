#include "vulkan/device/shared_device.h"

#include <algorithm>
#include <array>
#include <map>
#include <thread>
#include <tuple>

#include <fmt/format.h>

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

void require_statistics(const vk::raii::PhysicalDevice& device, const DeviceDescription& description) {
    if (has_extension(device, VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME)) {
        const auto chain = device.getFeatures2<vk::PhysicalDeviceFeatures2,
                                               vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR>();
        if (chain.get<vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR>().pipelineExecutableInfo)
            return;
    }
    refuse_device(fmt::format("device {} ({}) tells nothing of compiled kernels: its driver lacks {}",
                              description.index, description.name,
                              VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME),
                  "choose another with device.index, or Mesa's RADV without a device: docs/gpu.md");
}

void read_limits(SharedDevice& d) {
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

vk::raii::Device make_device(const SharedDevice& d) {
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
    vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR with_statistics(true);
    if (d.config.compiles_only) {
        extensions.push_back(VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
        with_13.pNext = &with_statistics;
    }
    if (has_extension(d.physical, VK_EXT_MEMORY_BUDGET_EXTENSION_NAME))
        extensions.push_back(VK_EXT_MEMORY_BUDGET_EXTENSION_NAME);
    return {d.physical, vk::DeviceCreateInfo({}, queue, {}, extensions, nullptr, &features)};
}

vk::raii::DescriptorSetLayout make_set_layout(const SharedDevice& d) {
    std::vector<vk::DescriptorSetLayoutBinding> bindings;
    const auto add = [&](uint32_t first, uint32_t count, vk::DescriptorType type) {
        for (uint32_t i = 0; i < count; ++i) bindings.emplace_back(first + i, type, 1, d.shader_stages);
    };
    add(0, scalar::kStorageBindingCount, vk::DescriptorType::eStorageBuffer);
    add(scalar::kFirstTexelBinding, scalar::kTexelBindingCount, vk::DescriptorType::eUniformTexelBuffer);
    return {d.device, vk::DescriptorSetLayoutCreateInfo({}, bindings)};
}

void make_shared_objects(SharedDevice& d) {
    d.queue = vk::raii::Queue(d.device, d.family, 0);
    d.set_name(d.queue, "relief queue");
    d.set_layout = make_set_layout(d);
    d.set_name(d.set_layout, "relief bindings");
    const vk::PushConstantRange push(d.shader_stages, 0, scalar::kMaxPushBytes);
    d.pipeline_layout =
        vk::raii::PipelineLayout(d.device, vk::PipelineLayoutCreateInfo({}, *d.set_layout, push));
    d.set_name(d.pipeline_layout, "relief pipeline layout");

    std::vector<uint8_t> cached;
    if (!d.config.pipeline_cache.empty())
        cached = read_pipeline_cache(d.config.pipeline_cache, d.physical.getProperties());
    d.bytes_in_file = cached.size();
    d.pipeline_cache =
        vk::raii::PipelineCache(d.device, vk::PipelineCacheCreateInfo({}, cached.size(), cached.data()));
    d.set_name(d.pipeline_cache, "relief pipeline cache");
}

} // namespace

SharedDevice::SharedDevice(const Device::Config& wanted)
    : config(wanted),
      messages(wanted.is_validated ? std::make_unique<MessageLog>() : nullptr),
      instance(make_instance(messages.get())) {
    check_vulkan("making the device", [&] {
        physical = choose_device(instance.handle, config, description);
        if (config.compiles_only) require_statistics(physical, description);
        read_limits(*this);
        device = make_device(*this);
        set_name(device, "relief device");
        make_shared_objects(*this);
    });
}

void SharedDevice::save_pipelines() {
    if (config.pipeline_cache.empty()) return;
    const std::lock_guard lock(file_mutex);
    try {
        const std::vector<uint8_t> data = pipeline_cache.getData();
        if (data.size() != bytes_in_file) write_pipeline_cache(config.pipeline_cache, data);
        bytes_in_file = data.size();
    } catch (const vk::SystemError&) {
        // Saving fails on a lost device; the next run compiles the pipelines again.
    }
}

std::shared_ptr<SharedDevice> share_device(const Device::Config& config) {
    if (!config.is_shared) return std::make_shared<SharedDevice>(config);
    using Key = std::tuple<int, RenderMethod, std::filesystem::path, bool, bool>;
    static std::mutex mutex;
    // Never destroyed: drivers and layers, loaded later, have their own static objects destroyed before.
    static auto& devices = *new std::map<Key, std::shared_ptr<SharedDevice>>;
    const std::lock_guard lock(mutex);
    std::shared_ptr<SharedDevice>& place = devices[{config.index, config.method, config.pipeline_cache,
                                                    config.is_validated, config.compiles_only}];
    if (!place || place->is_lost) place = std::make_shared<SharedDevice>(config);
    return place;
}

} // namespace relief::vulkan
