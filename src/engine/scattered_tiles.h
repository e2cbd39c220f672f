// Tiles of the picture in an order that goes all over it: wherever a pass is stopped, the tiles that are done
// lie evenly among the others.
#pragma once

#include <vector>

#include "relief/render.h"

namespace relief {

/// The tiles of cut_into_windows(). Of any 2 x 2 that belong together one comes in the first quarter of the
/// order, one in the second and so on, likewise of any 2 x 2 such groups; which one is random, but always the
/// same.
std::vector<Window> cut_into_scattered_tiles(const Window& window, int edge);

} // namespace relief
