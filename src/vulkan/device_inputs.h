// Textures of the inputs of materials in device memory.
#pragma once

#include <cstdint>
#include <vector>

#include "prepare/textured_materials.h"
#include "vulkan/device_scene.h"
#include "vulkan/layout/device_scene.h"

namespace relief::vulkan {

/// The buffer of materials, as words: the materials, whose `inputs` are filled in, and what those refer to.
std::vector<uint32_t> join_inputs(std::vector<scalar::MaterialData> materials, const PreparedScene& scene,
                                  const DeviceScene& device_scene);

} // namespace relief::vulkan
