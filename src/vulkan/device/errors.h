// Translates Vulkan failures into library errors: operation, device and hint.
#pragma once

#include <string>
#include <string_view>

#include <vulkan/vulkan.hpp>

#include "relief/error.h"

namespace relief::vulkan {

inline constexpr const char* kUseCpu = "use device.engine = cpu";

/// Error{device_missing} for a lost or absent device, Error{out_of_memory} or else Error{failed}.
[[noreturn]] void throw_vulkan_error(std::string_view operation, const vk::SystemError& error);

/// Returns the result of `call`; rethrows a Vulkan exception as a relief::Error that names the operation.
template <class Call> decltype(auto) check_vulkan(std::string_view operation, const Call& call) {
    try {
        return call();
    } catch (const vk::SystemError& error) {
        throw_vulkan_error(operation, error);
    }
}

} // namespace relief::vulkan
