#include "vulkan/device/instance.h"

#include <algorithm>
#include <array>
#include <memory>

#include <fmt/format.h>

#include "vulkan/device/errors.h"

namespace relief::vulkan {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
constexpr const char* kNoDriverHint =
    "install a driver for the graphics card, or mesa-vulkan-drivers, or use device.engine = cpu";

VKAPI_ATTR VkBool32 VKAPI_CALL keep_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                            VkDebugUtilsMessageTypeFlagsEXT,
                                            const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    static_cast<MessageLog*>(user)->add(data->pMessage);
    return VK_FALSE;
}

bool has_name(const std::vector<vk::ExtensionProperties>& extensions, std::string_view name) {
    return std::ranges::any_of(extensions, [&](const auto& e) { return name == e.extensionName.data(); });
}

vk::raii::Context load_vulkan() {
    try {
        return vk::raii::Context();
    } catch (const std::runtime_error&) {
        throw Error(ErrorKind::device_missing,
                    {"the Vulkan loader libvulkan.so.1 is not installed", "Vulkan",
                     "install libvulkan1 and a driver, or use device.engine = cpu"});
    }
}

void require_validation_layer(const vk::raii::Context& context) {
    for (const vk::LayerProperties& layer : context.enumerateInstanceLayerProperties())
        if (std::string_view(kValidationLayer) == layer.layerName.data()) return;
    throw Error(ErrorKind::device_missing,
                {fmt::format("validation was requested, but the layer {} is not installed", kValidationLayer),
                 "Vulkan", "install vulkan-validationlayers"});
}

vk::raii::DebugUtilsMessengerEXT make_messenger(const vk::raii::Instance& instance, MessageLog* log) {
    using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
    using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
    return {instance, vk::DebugUtilsMessengerCreateInfoEXT(
                          {}, Severity::eWarning | Severity::eError,
                          Type::eGeneral | Type::eValidation | Type::ePerformance, keep_message, log)};
}

} // namespace

void MessageLog::add(std::string message) {
    const std::lock_guard lock(mutex_);
    messages_.push_back(std::move(message));
}

std::vector<std::string> MessageLog::copy() const {
    const std::lock_guard lock(mutex_);
    return messages_;
}

Instance make_instance(MessageLog* log) {
    Instance result{load_vulkan()};
    std::vector<const char*> layers, extensions;
    if (log) {
        require_validation_layer(result.context);
        layers.push_back(kValidationLayer);
        extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
    }
    result.has_debug_names =
        has_name(result.context.enumerateInstanceExtensionProperties(), VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (result.has_debug_names) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);

    const vk::ApplicationInfo application("relief", 1, "relief", 1, VK_API_VERSION_1_3);
    const std::array enabled = {vk::ValidationFeatureEnableEXT::eSynchronizationValidation};
    const vk::ValidationFeaturesEXT validation(enabled);
    vk::InstanceCreateInfo info({}, &application, layers, extensions);
    if (log) info.setPNext(&validation);
    try {
        result.handle = vk::raii::Instance(result.context, info);
    } catch (const vk::IncompatibleDriverError&) {
        throw Error(ErrorKind::device_missing, {"there is no Vulkan driver", "Vulkan", kNoDriverHint});
    } catch (const vk::SystemError& error) {
        throw_vulkan_error("vkCreateInstance", error);
    }
    if (log) result.messenger = make_messenger(result.handle, log);
    return result;
}

bool has_extension(const vk::raii::PhysicalDevice& device, std::string_view name) {
    return has_name(device.enumerateDeviceExtensionProperties(), name);
}

std::optional<uint32_t> find_compute_family(const vk::raii::PhysicalDevice& device) {
    const std::vector<vk::QueueFamilyProperties> families = device.getQueueFamilyProperties();
    std::optional<uint32_t> best;
    for (uint32_t i = 0; i < families.size(); ++i) {
        if (!(families[i].queueFlags & vk::QueueFlagBits::eCompute)) continue;
        const auto is_graphics = [&](uint32_t family) {
            return bool(families[family].queueFlags & vk::QueueFlagBits::eGraphics);
        };
        if (!best || (is_graphics(*best) && !is_graphics(i))) best = i;
    }
    return best;
}

std::optional<uint32_t> find_drawing_family(const vk::raii::PhysicalDevice& device) {
    const vk::QueueFlags wanted = vk::QueueFlagBits::eCompute | vk::QueueFlagBits::eGraphics;
    const std::vector<vk::QueueFamilyProperties> families = device.getQueueFamilyProperties();
    for (uint32_t i = 0; i < families.size(); ++i)
        if ((families[i].queueFlags & wanted) == wanted) return i;
    return std::nullopt;
}

} // namespace relief::vulkan
