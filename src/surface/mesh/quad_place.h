// The place of a quad of a subdivided mesh on that mesh.
#pragma once

#include <array>
#include <cstdint>

#include "math/vec.h"

namespace relief {

/// Place of a quad: its corners on a face of the mesh, or on a polygon's part beside its corner `part`.
struct QuadPlace {
    uint32_t face = 0, part = 0;
    std::array<Vec2<double>, 4> corners;
};

} // namespace relief
