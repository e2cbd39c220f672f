// The Vulkan instance with or without validation, and what each physical device offers. Included by the files
// behind device.h only.
#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <vulkan/vulkan_raii.hpp>

#include "vulkan/device/device.h"

namespace relief::vulkan {

/// Warnings and errors of the validation layer. Any thread may add.
class MessageLog {
  public:
    void add(std::string message);
    std::vector<std::string> copy() const;

  private:
    mutable std::mutex mutex_;
    std::vector<std::string> messages_;
};

/// An instance and what it was made with.
struct Instance {
    vk::raii::Context context;
    vk::raii::Instance handle = nullptr;
    vk::raii::DebugUtilsMessengerEXT messenger = nullptr;
    bool has_debug_names = false;
};

/// `log` null: no validation. Otherwise Khronos validation with synchronisation validation writes to it,
/// which must outlive the instance. Throws Error{device_missing} without a loader, a driver or the layer.
Instance make_instance(MessageLog* log);

/// What list_devices() tells of one device.
DeviceDescription describe_device(const vk::raii::PhysicalDevice& device, uint32_t index);

/// Whether the device offers an extension of this name.
bool has_extension(const vk::raii::PhysicalDevice& device, std::string_view name);

/// The family of queues that computes: with the fewest other abilities where there are several. Nothing
/// without one.
std::optional<uint32_t> find_compute_family(const vk::raii::PhysicalDevice& device);

/// The first family that computes and draws.
std::optional<uint32_t> find_drawing_family(const vk::raii::PhysicalDevice& device);

} // namespace relief::vulkan
