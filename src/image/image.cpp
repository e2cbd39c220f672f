#include "relief/image.h"

#include <algorithm>

#include "base/check.h"

namespace relief {

std::optional<size_t> Image::find_channel(const std::string& name) const {
    const auto found = std::find(channels.begin(), channels.end(), name);
    if (found == channels.end()) return std::nullopt;
    return size_t(found - channels.begin());
}

float Image::at(int x, int y, size_t channel) const {
    DCHECK(x >= x0 && x < x0 + width && y >= y0 && y < y0 + height && channel < channels.size());
    return pixels[(size_t(y - y0) * size_t(width) + size_t(x - x0)) * channels.size() + channel];
}

float& Image::at(int x, int y, size_t channel) {
    DCHECK(x >= x0 && x < x0 + width && y >= y0 && y < y0 + height && channel < channels.size());
    return pixels[(size_t(y - y0) * size_t(width) + size_t(x - x0)) * channels.size() + channel];
}

} // namespace relief
