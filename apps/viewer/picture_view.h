// Pictures and their layers as bytes for the screen.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "relief/image.h"
#include "viewer/display_table.h"

namespace relief::viewer {

enum class View { color, normal, depth, uv, object, cost, samples };
inline constexpr const char* kViewNames[] = {"colour", "normal", "depth", "uv", "object", "cost", "samples"};

struct ViewSettings {
    View view = View::color;
    float exposure = 0; ///< of the colour, in powers of two
};

/// Red, green, blue and 255 of each pixel, row 0 at the top. Of the colour: the display transform of what was
/// exposed, before black. Normals: 0.5 + 0.5 N. Depth: near white, far grey, nothing black. uv: red and
/// green. Objects: a colour each. Cost and samples:
/// from blue, the least, to red, the most.
std::vector<uint8_t> make_view(const Image& image, const ViewSettings& settings, const DisplayTable& display);

} // namespace relief::viewer
