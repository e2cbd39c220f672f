// Values of pictures as their sources give them.
#pragma once

#include <vector>

#include "io/picture/pixel_source.h"

namespace relief {

/// All channels of all pixels, row by row.
inline std::vector<float> read_all(PixelSource& source) {
    const PixelHeader& header = source.header();
    const size_t channels = header.channels.size();
    std::vector<float> values(size_t(header.width) * size_t(header.height) * channels);
    source.read_floats(int(channels), channels, values.data());
    return values;
}

} // namespace relief
