// How the images of a map are numbered.
#pragma once

#include <cstdint>

namespace relief {

using TileIndex = uint16_t; ///< number of an image of a map, from 0

} // namespace relief
