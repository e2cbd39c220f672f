// Least and greatest texel of a rectangle, many texels at a time.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "relief/image.h"

namespace relief {

struct ChannelRange {
    std::array<float, 3> low, high;
};

/// Texels [x0, x1] x [y0, y1] of a texture, inclusive.
struct TexelRectangle {
    uint32_t x0, y0, x1, y1;
};

/// Range of the first three channels over a rectangle of the texture; nothing if a value is not finite.
std::optional<ChannelRange> find_texel_range(const Texture& texture, const TexelRectangle& rectangle);

/// Throws bad_input that names the first texel of a rectangle that is not finite.
[[noreturn]] void refuse_bad_texel(const Texture& texture, const TexelRectangle& rectangle);

} // namespace relief
