// All texels of a scene in two buffers, one per precision, so that devices need not index arrays of images.
#pragma once

#include <memory>
#include <vector>

#include "relief/image.h"
#include "vulkan/device/buffer.h"
#include "vulkan/layout/device_scene.h"

namespace relief::vulkan {

class TexelStore {
  public:
    /// Reserves space for the texels; they are copied when the buffers are created.
    scalar::TextureData add(std::shared_ptr<const Texture> texture);

    /// rgba32_float, rgba16_float. Throw Error{out_of_memory} for more texels than the device can address.
    Buffer make_float_buffer(const Device& device) const;
    Buffer make_half_buffer(const Device& device) const;

  private:
    std::vector<std::shared_ptr<const Texture>> textures_;
    std::vector<scalar::TextureData> places_;
    uint64_t float_count_ = 0, half_count_ = 0; ///< texels
};

} // namespace relief::vulkan
