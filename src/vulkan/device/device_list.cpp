// Required device features and limits, and the list of devices.
#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "vulkan/device/errors.h"
#include "vulkan/device/instance.h"
#include "vulkan/layout/bindings.h"

namespace relief::vulkan {
namespace {

constexpr uint32_t kLeastTexelCount = 1u << 24;

void require_features(const vk::raii::PhysicalDevice& device, std::vector<std::string>& missing) {
    const auto chain = device.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features,
                                           vk::PhysicalDeviceVulkan13Features>();
    const auto& core = chain.get<vk::PhysicalDeviceFeatures2>().features;
    const auto& with_12 = chain.get<vk::PhysicalDeviceVulkan12Features>();
    const auto& with_13 = chain.get<vk::PhysicalDeviceVulkan13Features>();
    const auto properties =
        device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceSubgroupProperties>();
    const vk::SubgroupFeatureFlags subgroups =
        properties.get<vk::PhysicalDeviceSubgroupProperties>().supportedOperations;
    const auto require = [&](vk::Bool32 is_there, const char* name) {
        if (!is_there) missing.emplace_back(name);
    };
    require(core.shaderInt64, "shaderInt64");
    require(with_12.shaderBufferInt64Atomics, "shaderBufferInt64Atomics");
    require(with_12.scalarBlockLayout, "scalarBlockLayout");
    require(with_12.hostQueryReset, "hostQueryReset");
    require(with_13.synchronization2, "synchronization2");
    require(with_13.maintenance4, "maintenance4");
    require(bool(subgroups & vk::SubgroupFeatureFlagBits::eArithmetic), "VK_SUBGROUP_FEATURE_ARITHMETIC_BIT");
    require(bool(subgroups & vk::SubgroupFeatureFlagBits::eBallot), "VK_SUBGROUP_FEATURE_BALLOT_BIT");
}

void require_limits(const vk::PhysicalDeviceLimits& limits, std::vector<std::string>& missing) {
    const auto require = [&](uint32_t value, uint32_t least, const char* name) {
        if (value < least) missing.push_back(fmt::format("{} {} (has {})", name, least, value));
    };
    const uint32_t storage = scalar::kStorageBindingCount;
    const uint32_t texels = scalar::kTexelBindingCount;
    require(limits.maxPerStageDescriptorStorageBuffers, storage, "maxPerStageDescriptorStorageBuffers");
    require(limits.maxDescriptorSetStorageBuffers, storage, "maxDescriptorSetStorageBuffers");
    require(limits.maxPerStageDescriptorSampledImages, texels, "maxPerStageDescriptorSampledImages");
    require(limits.maxDescriptorSetSampledImages, texels, "maxDescriptorSetSampledImages");
    require(limits.maxPerStageResources, storage + texels, "maxPerStageResources");
    require(limits.maxComputeWorkGroupInvocations, 256, "maxComputeWorkGroupInvocations");
    require(limits.maxComputeWorkGroupSize[0], 256, "maxComputeWorkGroupSize[0]");
    require(limits.maxComputeSharedMemorySize, 16u << 10, "maxComputeSharedMemorySize");
    require(limits.maxPushConstantsSize, scalar::kMaxPushBytes, "maxPushConstantsSize");
    require(limits.maxTexelBufferElements, kLeastTexelCount, "maxTexelBufferElements");
}

/// Additional requirements of the methods fragment and hybrid.
std::vector<std::string> find_missing_to_draw(const vk::raii::PhysicalDevice& device) {
    std::vector<std::string> missing;
    const auto chain = device.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan13Features>();
    if (!find_drawing_family(device)) missing.emplace_back("a queue with VK_QUEUE_GRAPHICS_BIT");
    const auto& core = chain.get<vk::PhysicalDeviceFeatures2>().features;
    if (!core.fragmentStoresAndAtomics) missing.emplace_back("fragmentStoresAndAtomics");
    if (!core.largePoints) missing.emplace_back("largePoints");
    if (!chain.get<vk::PhysicalDeviceVulkan13Features>().dynamicRendering)
        missing.emplace_back("dynamicRendering");
    const vk::PhysicalDeviceLimits limits = device.getProperties().limits;
    const uint32_t outputs = limits.maxFragmentCombinedOutputResources;
    if (outputs < scalar::kStorageBindingCount)
        missing.push_back(fmt::format("maxFragmentCombinedOutputResources {} (has {})",
                                      scalar::kStorageBindingCount, outputs));
    if (limits.pointSizeRange[1] < float(scalar::kFragmentSquare))
        missing.push_back(
            fmt::format("pointSizeRange[1] {} (has {})", scalar::kFragmentSquare, limits.pointSizeRange[1]));
    return missing;
}

uint64_t largest_local_heap(const vk::raii::PhysicalDevice& device) {
    const vk::PhysicalDeviceMemoryProperties memory = device.getMemoryProperties();
    uint64_t largest = 0;
    for (uint32_t i = 0; i < memory.memoryHeapCount; ++i)
        if (memory.memoryHeaps[i].flags & vk::MemoryHeapFlagBits::eDeviceLocal)
            largest = std::max<uint64_t>(largest, memory.memoryHeaps[i].size);
    return largest;
}

} // namespace

DeviceDescription describe_device(const vk::raii::PhysicalDevice& device, uint32_t index) {
    const vk::PhysicalDeviceProperties core = device.getProperties();
    DeviceDescription result;
    result.index = index;
    result.name = core.deviceName.data();
    result.is_cpu = core.deviceType == vk::PhysicalDeviceType::eCpu;
    result.memory_bytes = largest_local_heap(device);
    if (core.apiVersion < VK_API_VERSION_1_3) {
        result.missing.push_back(fmt::format("Vulkan 1.3 (has {}.{})", VK_API_VERSION_MAJOR(core.apiVersion),
                                             VK_API_VERSION_MINOR(core.apiVersion)));
        return result;
    }
    const auto chain =
        device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan12Properties>();
    const auto& driver = chain.get<vk::PhysicalDeviceVulkan12Properties>();
    result.driver = fmt::format("{} {}", driver.driverName.data(), driver.driverInfo.data());
    if (!find_compute_family(device)) result.missing.emplace_back("a queue with VK_QUEUE_COMPUTE_BIT");
    require_features(device, result.missing);
    require_limits(core.limits, result.missing);
    result.missing_to_draw = find_missing_to_draw(device);
    return result;
}

std::vector<DeviceDescription> list_devices() {
    try {
        const Instance instance = make_instance(nullptr);
        std::vector<DeviceDescription> result;
        for (const vk::raii::PhysicalDevice& device : vk::raii::PhysicalDevices(instance.handle))
            result.push_back(describe_device(device, uint32_t(result.size())));
        return result;
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::device_missing) throw;
        return {};
    } catch (const vk::SystemError& error) {
        if (vk::Result(error.code().value()) == vk::Result::eErrorInitializationFailed) return {};
        throw_vulkan_error("vkEnumeratePhysicalDevices", error);
    }
}

} // namespace relief::vulkan
