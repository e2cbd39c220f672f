// The Vulkan instance, with or without validation, and queries of devices. For device.h's sources only.
#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <vulkan/vulkan_raii.hpp>

#include "vulkan/device/device.h"

namespace relief::vulkan {

/// Warnings and errors of the validation layer. Thread safe.
class MessageLog {
  public:
    void add(std::string message);
    std::vector<std::string> copy() const;

  private:
    mutable std::mutex mutex_;
    std::vector<std::string> messages_;
};

/// An instance with the objects that it depends on.
struct Instance {
    vk::raii::Context context;
    vk::raii::Instance handle = nullptr;
    vk::raii::DebugUtilsMessengerEXT messenger = nullptr;
    bool has_debug_names = false;
};

/// `log` null: no validation. Otherwise Khronos validation with synchronisation validation writes to it,
/// which must outlive the instance. Throws Error{device_missing} without a loader, a driver or the layer.
Instance make_instance(MessageLog* log);

/// The entry of list_devices() for one device.
DeviceDescription describe_device(const vk::raii::PhysicalDevice& device, uint32_t index);

/// Whether the device supports an extension.
bool has_extension(const vk::raii::PhysicalDevice& device, std::string_view name);

/// The queue family with compute and the fewest other capabilities; nullopt if there is none.
std::optional<uint32_t> find_compute_family(const vk::raii::PhysicalDevice& device);

/// The first queue family with compute and graphics.
std::optional<uint32_t> find_drawing_family(const vk::raii::PhysicalDevice& device);

} // namespace relief::vulkan
