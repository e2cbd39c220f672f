#include "vulkan/device/errors.h"

#include <fmt/format.h>

namespace relief::vulkan {

void throw_vulkan_error(std::string_view operation, const vk::SystemError& error) {
    const auto result = vk::Result(error.code().value());
    const std::string cause = vk::to_string(result);
    switch (result) {
    case vk::Result::eErrorDeviceLost:
        throw Error(ErrorKind::device_missing,
                    {fmt::format("the device was lost: {}", operation), "Vulkan", kUseCpu});
    case vk::Result::eErrorOutOfHostMemory:
    case vk::Result::eErrorOutOfDeviceMemory:
    case vk::Result::eErrorOutOfPoolMemory:
        throw Error(ErrorKind::out_of_memory,
                    {fmt::format("no memory left: {} ({})", operation, cause), "Vulkan", kUseCpu});
    case vk::Result::eErrorIncompatibleDriver:
    case vk::Result::eErrorInitializationFailed:
    case vk::Result::eErrorFeatureNotPresent:
    case vk::Result::eErrorExtensionNotPresent:
    case vk::Result::eErrorLayerNotPresent:
        throw Error(ErrorKind::device_missing,
                    {fmt::format("{} failed: {}", operation, cause), "Vulkan", kUseCpu});
    default:
        throw Error(ErrorKind::failed, {fmt::format("{} failed: {}", operation, cause), "Vulkan", kUseCpu});
    }
}

} // namespace relief::vulkan
