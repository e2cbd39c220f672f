#include "surface/map/texel_range.h"

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "math/extrema.h"
#include "relief/error.h"
#include "surface/map/texels.h"

namespace relief {

namespace {

template <class Value>
TexelRows<Value> view_rows(const Texture& texture, const std::vector<Value>& values,
                           const TexelRectangle& rectangle) {
    return {values.data() + texture.find_texel(rectangle.x0, rectangle.y0), texture.stride,
            texture.find_texel(0, 1), size_t(rectangle.x1) - rectangle.x0 + 1,
            size_t(rectangle.y1) - rectangle.y0 + 1};
}

} // namespace

std::optional<ChannelRange> find_texel_range(const Texture& texture, const TexelRectangle& rectangle) {
    const Extrema extrema = texture.halves.empty()
                                ? find_extrema(view_rows(texture, texture.floats, rectangle))
                                : find_extrema(view_rows(texture, texture.halves, rectangle));
    if (!extrema.is_finite) return std::nullopt;
    return ChannelRange{extrema.low, extrema.high};
}

void refuse_bad_texel(const Texture& texture, const TexelRectangle& rectangle) {
    for (uint32_t y = rectangle.y0; y <= rectangle.y1; ++y)
        for (uint32_t x = rectangle.x0; x <= rectangle.x1; ++x) {
            const std::array<float, 3> texel = read_texel(texture, x, y);
            for (int c = 0; c < 3; ++c)
                if (!std::isfinite(texel[c]))
                    throw Error(
                        ErrorKind::bad_input,
                        {fmt::format("map holds {}{}", std::isnan(texel[c]) ? "NaN" : "infinity",
                                     texture.channel_count < 3 ? std::string()
                                                               : fmt::format(" in channel {}", "RGB"[c])),
                         fmt::format("{}, pixel ({}, {})", texture.file, x, y), "repair the map"});
        }
    throw Error(ErrorKind::bad_input, {"map holds NaN or infinity", texture.file, "repair the map"});
}

} // namespace relief
