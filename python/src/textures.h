// Texels from and to NumPy arrays.
#pragma once

#include <memory>
#include <string>

#include <nanobind/nanobind.h>

#include "relief/image.h"

namespace relief::python {

/// `array`: contiguous (height, width, channels), of uint8, uint16, float16 or float32, 1 to 4 channels, row
/// 0 at the top. `name` is for messages.
Texture make_texture(nanobind::handle array, const std::string& name);

/// What Python calls _relief.Texture.
struct SharedTexture {
    std::shared_ptr<const Texture> texture;
};

/// (height, width, channels) float32: the channels that the texture has.
nanobind::object make_texel_array(const Texture& texture);

} // namespace relief::python
