// Failures of Vulkan as errors of the library: what was tried, on which device, and what to do.
#pragma once

#include <string>
#include <string_view>

#include <vulkan/vulkan.hpp>

#include "relief/error.h"

namespace relief::vulkan {

inline constexpr const char* kUseCpu = "use device.engine = cpu";

/// Error{device_missing} for a lost or absent device, Error{out_of_memory} for memory, else Error{failed}.
[[noreturn]] void throw_vulkan_error(std::string_view operation, const vk::SystemError& error);

/// Returns what `call` returns; an exception of Vulkan leaves as relief::Error that names the operation.
template <class Call> decltype(auto) check_vulkan(std::string_view operation, const Call& call) {
    try {
        return call();
    } catch (const vk::SystemError& error) {
        throw_vulkan_error(operation, error);
    }
}

} // namespace relief::vulkan
