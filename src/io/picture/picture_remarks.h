// Remarks that readers of pictures make beside the pixels.
#pragma once

#include <string>
#include <vector>

namespace relief {

struct PictureRemarks {
    std::vector<std::string> warnings, notes; ///< as those of Texture
    bool is_cube_map = false;
};

} // namespace relief
