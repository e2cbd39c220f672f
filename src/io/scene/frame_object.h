// Where a camera stands so that a mesh with its displacement fills the picture.
#pragma once

#include "relief/scene.h"

namespace relief {

/// Camera for a square or wider picture: bodies are seen from above the front, flat ones from the side that
/// they face; the object takes about 85 % of the height, or of the square's width where it is wider than
/// high. The displacement counts in coarse steps, so that the same relief in another encoding has the same
/// camera. `map` may be null. Scans about a quarter of a million samples.
Camera frame_object(const Mesh& mesh, const Displacement* map);

} // namespace relief
