// Maps of integers without their stairs: each texel is moved by up to half a step.
#pragma once

#include <cstdint>

#include "surface/map/texel_plane.h"

namespace relief {

/// Size of a step of integers of 8 and 16 bits, scaled to [0, 1]; 0 of other samples.
float get_quantization_step(SampleType type);

/// Texels beyond the result on each side that it depends on.
int64_t get_dequantization_reach();

/// Smooths a plane. Only what is get_dequantization_reach() from its sides is of use afterwards.
void dequantize(TexelPlane& plane, float step);

} // namespace relief
