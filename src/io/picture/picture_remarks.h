// Remarks that readers of pictures make beside the pixels.
#pragma once

#include <string>
#include <vector>

namespace relief {

struct PictureRemarks {
    std::vector<std::string> warnings, notes; ///< as those of Texture
    bool is_cube_map = false;
};

/// Returns the warning about a picture of four inks.
inline std::string describe_inks(const std::string& name) {
    return name +
           ": is CMYK, and its colours become RGB without its profile, so that they differ from what other "
           "programs show: save it as RGB";
}

} // namespace relief
