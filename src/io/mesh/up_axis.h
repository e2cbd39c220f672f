// Turns that bring an axis of a mesh file up.
#pragma once

#include "math/vec.h"
#include "relief/io.h"

namespace relief {

/// Returns the angles by which `rotate_degrees` of a transform turns this axis to y.
Vec3f get_upright_turn(UpAxis up);

} // namespace relief
