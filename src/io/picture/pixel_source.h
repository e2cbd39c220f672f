// Pixels of an open picture, whatever library decodes them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "relief/image.h"

namespace relief {

/// What the header of a picture says.
struct PixelHeader {
    int x = 0, y = 0, width = 0, height = 0;                     ///< data window
    int full_x = 0, full_y = 0, full_width = 0, full_height = 0; ///< display window
    int depth = 1;                                               ///< slices of a volume
    bool is_deep = false;
    SampleType type = SampleType::float32;       ///< of all channels together: none of them loses precision
    uint64_t pixel_bytes = 0;                    ///< as stored, all channels
    std::vector<std::string> channels;           ///< colours first: R, G, B, A or X, Y, Z; layer by layer
    std::map<std::string, std::string> metadata; ///< texts, without those of the coding
};

class PixelSource {
  public:
    virtual ~PixelSource() = default;
    virtual const PixelHeader& header() const = 0;
    /// The first `channel_count` channels of all pixels, top row first; the next pixel is `stride` values
    /// further. Integers are scaled to [0, 1]. Throws Error{bad_input} for a damaged or incomplete file.
    virtual void read_floats(int channel_count, size_t stride, float* values) = 0;
    /// The same as bits of binary16, for pictures of that type.
    virtual void read_halves(int channel_count, size_t stride, uint16_t* values) = 0;
    /// Lists what the last reading noticed, in words for the user.
    virtual std::vector<std::string> list_warnings() const { return {}; }
};

} // namespace relief
