// Vulkan objects behind Kernel and BindingTable, for their own sources, commands.cpp and tests.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "vulkan/device/device_internals.h"
#include "vulkan/device/kernel.h"

namespace relief::vulkan {

struct Kernel::Implementation {
    std::string name;
    uint32_t group_size = 0;
    bool is_drawn = false;
    std::shared_ptr<const vk::raii::Pipeline> pipeline;
};

struct BindingTable::Implementation {
    Device::Implementation* device = nullptr;
    std::vector<Buffer> unbound; ///< zeros: one for storage, one per texel format
    Buffer albedos;              ///< always bound at kBindAlbedos
    vk::raii::DescriptorPool pool = nullptr;
    vk::raii::DescriptorSet set = nullptr;
};

} // namespace relief::vulkan
