// A Vulkan layer that makes a sound device fail. Its orders are environment variables:
//   RELIEF_FAULT_FEATURE=NAME      the device reports this feature as absent
//   RELIEF_FAULT_HEAP_BYTES=N      its heaps of device memory report at most N bytes
//   RELIEF_FAULT_LOST_SUBMIT=N     the N-th submission, from 1, and all later ones return
//   VK_ERROR_DEVICE_LOST
//   RELIEF_FAULT_MEMORY_AFTER=N    the first buffer made after N submissions finds no memory left, once;
//                                  stderr tells when
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <string_view>

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#define FAULT_EXPORT extern "C" __attribute__((visibility("default")))

namespace {

/// Functions of the next layer. Queried when the instance or device is created: later the loader would return
/// those of the first layer.
struct InstanceFunctions {
    PFN_vkGetInstanceProcAddr get_address;
    PFN_vkCreateDevice create_device;
    PFN_vkGetPhysicalDeviceFeatures2 get_features;
    PFN_vkGetPhysicalDeviceMemoryProperties get_memory;
    PFN_vkGetPhysicalDeviceMemoryProperties2 get_memory_2;
};

struct DeviceFunctions {
    PFN_vkGetDeviceProcAddr get_address;
    PFN_vkQueueSubmit2 submit_2;
    PFN_vkCreateBuffer create_buffer;
};

/// By the loader's dispatch table, which physical devices share with their instance and queues with their
/// device.
template <class Functions> class NextLayers {
  public:
    template <class Handle> void add(Handle handle, const Functions& next) {
        const std::lock_guard lock(mutex_);
        next_[find_key(handle)] = next;
    }
    template <class Handle> Functions find(Handle handle) {
        const std::lock_guard lock(mutex_);
        return next_.at(find_key(handle));
    }

  private:
    template <class Handle> static void* find_key(Handle handle) { return *reinterpret_cast<void**>(handle); }
    std::mutex mutex_;
    std::map<void*, Functions> next_;
};

NextLayers<InstanceFunctions> next_of_instances;
NextLayers<DeviceFunctions> next_of_devices;
std::atomic<long> submission_count = 0;
std::atomic<bool> has_refused_memory = false;

/// The number that an order names; 0 without the order.
long read_number(const char* name) {
    const char* number = std::getenv(name);
    return number ? std::strtol(number, nullptr, 10) : 0;
}

/// The loader's link to the next layer, of which the chain tells.
template <class Link> Link* find_link(const void* chain, VkStructureType type) {
    for (auto* info = static_cast<Link*>(const_cast<void*>(chain)); info;
         info = static_cast<Link*>(const_cast<void*>(info->pNext)))
        if (info->sType == type && info->function == VK_LAYER_LINK_INFO) return info;
    return nullptr;
}

VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo* info,
                                               const VkAllocationCallbacks* allocator, VkInstance* instance) {
    auto* link =
        find_link<VkLayerInstanceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    if (!link) return VK_ERROR_INITIALIZATION_FAILED;
    const PFN_vkGetInstanceProcAddr next = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create = reinterpret_cast<PFN_vkCreateInstance>(next(nullptr, "vkCreateInstance"));
    const VkResult result = create(info, allocator, instance);
    if (result != VK_SUCCESS) return result;
    const auto find = [&](const char* name) { return next(*instance, name); };
    next_of_instances.add(
        *instance, {next, reinterpret_cast<PFN_vkCreateDevice>(find("vkCreateDevice")),
                    reinterpret_cast<PFN_vkGetPhysicalDeviceFeatures2>(find("vkGetPhysicalDeviceFeatures2")),
                    reinterpret_cast<PFN_vkGetPhysicalDeviceMemoryProperties>(
                        find("vkGetPhysicalDeviceMemoryProperties")),
                    reinterpret_cast<PFN_vkGetPhysicalDeviceMemoryProperties2>(
                        find("vkGetPhysicalDeviceMemoryProperties2"))});
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                             const VkAllocationCallbacks* allocator, VkDevice* device) {
    auto* link = find_link<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    if (!link) return VK_ERROR_INITIALIZATION_FAILED;
    const PFN_vkGetDeviceProcAddr next = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const VkResult result = next_of_instances.find(physical).create_device(physical, info, allocator, device);
    if (result == VK_SUCCESS)
        next_of_devices.add(*device,
                            {next, reinterpret_cast<PFN_vkQueueSubmit2>(next(*device, "vkQueueSubmit2")),
                             reinterpret_cast<PFN_vkCreateBuffer>(next(*device, "vkCreateBuffer"))});
    return result;
}

/// A feature that can be taken away: its name, the struct that tells of it, and where.
struct Feature {
    const char* name;
    VkStructureType type;
    size_t offset;
};

#define CORE_FEATURE(name)                                                                                   \
    {                                                                                                        \
#name, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,                                                 \
            offsetof(VkPhysicalDeviceFeatures2, features) + offsetof(VkPhysicalDeviceFeatures, name)         \
    }
#define FEATURE_12(name)                                                                                     \
    {                                                                                                        \
#name, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,                                        \
            offsetof(VkPhysicalDeviceVulkan12Features, name)                                                 \
    }
#define FEATURE_13(name)                                                                                     \
    {                                                                                                        \
#name, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,                                        \
            offsetof(VkPhysicalDeviceVulkan13Features, name)                                                 \
    }
constexpr Feature kFeatures[] = {CORE_FEATURE(shaderInt64),
                                 FEATURE_12(shaderBufferInt64Atomics),
                                 FEATURE_12(scalarBlockLayout),
                                 FEATURE_12(hostQueryReset),
                                 FEATURE_13(synchronization2),
                                 FEATURE_13(maintenance4),
                                 CORE_FEATURE(fragmentStoresAndAtomics)};

VKAPI_ATTR void VKAPI_CALL get_features(VkPhysicalDevice device, VkPhysicalDeviceFeatures2* features) {
    next_of_instances.find(device).get_features(device, features);
    const char* absent = std::getenv("RELIEF_FAULT_FEATURE");
    for (auto* part = reinterpret_cast<VkBaseOutStructure*>(features); part && absent; part = part->pNext)
        for (const Feature& feature : kFeatures)
            if (part->sType == feature.type && std::string_view(absent) == feature.name)
                std::memset(reinterpret_cast<char*>(part) + feature.offset, 0, sizeof(VkBool32));
}

void shrink_heaps(VkPhysicalDeviceMemoryProperties& memory) {
    const char* bytes = std::getenv("RELIEF_FAULT_HEAP_BYTES");
    if (!bytes) return;
    for (uint32_t i = 0; i < memory.memoryHeapCount; ++i)
        if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
            memory.memoryHeaps[i].size =
                std::min<VkDeviceSize>(memory.memoryHeaps[i].size, std::strtoull(bytes, nullptr, 10));
}

VKAPI_ATTR void VKAPI_CALL get_memory(VkPhysicalDevice device, VkPhysicalDeviceMemoryProperties* memory) {
    next_of_instances.find(device).get_memory(device, memory);
    shrink_heaps(*memory);
}

VKAPI_ATTR void VKAPI_CALL get_memory_2(VkPhysicalDevice device, VkPhysicalDeviceMemoryProperties2* memory) {
    next_of_instances.find(device).get_memory_2(device, memory);
    shrink_heaps(memory->memoryProperties);
}

VKAPI_ATTR VkResult VKAPI_CALL submit_2(VkQueue queue, uint32_t count, const VkSubmitInfo2* submissions,
                                        VkFence fence) {
    const long number = ++submission_count, first_lost = read_number("RELIEF_FAULT_LOST_SUBMIT");
    if (first_lost > 0 && number >= first_lost) return VK_ERROR_DEVICE_LOST;
    return next_of_devices.find(queue).submit_2(queue, count, submissions, fence);
}

VKAPI_ATTR VkResult VKAPI_CALL create_buffer(VkDevice device, const VkBufferCreateInfo* info,
                                             const VkAllocationCallbacks* allocator, VkBuffer* buffer) {
    const long submissions = read_number("RELIEF_FAULT_MEMORY_AFTER");
    if (submissions > 0 && submission_count >= submissions && !has_refused_memory.exchange(true)) {
        std::fprintf(stderr, "fault layer: no memory after %ld submissions\n", submission_count.load());
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    return next_of_devices.find(device).create_buffer(device, info, allocator, buffer);
}

PFN_vkVoidFunction VKAPI_CALL get_instance_address(VkInstance instance, const char* name);
PFN_vkVoidFunction VKAPI_CALL get_device_address(VkDevice device, const char* name);

PFN_vkVoidFunction find_own(std::string_view name) {
    const std::pair<const char*, PFN_vkVoidFunction> own[] = {
        {"vkGetInstanceProcAddr", PFN_vkVoidFunction(get_instance_address)},
        {"vkGetDeviceProcAddr", PFN_vkVoidFunction(get_device_address)},
        {"vkCreateInstance", PFN_vkVoidFunction(create_instance)},
        {"vkCreateDevice", PFN_vkVoidFunction(create_device)},
        {"vkGetPhysicalDeviceFeatures2", PFN_vkVoidFunction(get_features)},
        {"vkGetPhysicalDeviceMemoryProperties", PFN_vkVoidFunction(get_memory)},
        {"vkGetPhysicalDeviceMemoryProperties2", PFN_vkVoidFunction(get_memory_2)},
        {"vkQueueSubmit2", PFN_vkVoidFunction(submit_2)},
        {"vkCreateBuffer", PFN_vkVoidFunction(create_buffer)}};
    for (const auto& [own_name, function] : own)
        if (name == own_name) return function;
    return nullptr;
}

PFN_vkVoidFunction VKAPI_CALL get_instance_address(VkInstance instance, const char* name) {
    if (const PFN_vkVoidFunction own = find_own(name)) return own;
    return instance ? next_of_instances.find(instance).get_address(instance, name) : nullptr;
}

PFN_vkVoidFunction VKAPI_CALL get_device_address(VkDevice device, const char* name) {
    const std::string_view own_names[] = {"vkQueueSubmit2", "vkCreateBuffer", "vkGetDeviceProcAddr"};
    if (std::find(std::begin(own_names), std::end(own_names), name) != std::end(own_names))
        return find_own(name);
    return next_of_devices.find(device).get_address(device, name);
}

} // namespace

FAULT_EXPORT VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* interface) {
    interface->loaderLayerInterfaceVersion = 2;
    interface->pfnGetInstanceProcAddr = get_instance_address;
    interface->pfnGetDeviceProcAddr = get_device_address;
    interface->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
