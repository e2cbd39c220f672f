// From linear Rec.709 radiance to what a screen shows.
#pragma once

#include "relief/types.h"

namespace relief {

/// Filmic curve in [0, 1], still linear: Hill's fit of the ACES reference and output transforms (S. Hill,
/// BakingLab, 2015), exposed so that middle grey stays middle grey. Bright colours fade towards white instead
/// of turning hue. Negative and NaN components count as 0, infinite ones as very bright.
Vec3f apply_filmic_curve(const Vec3f& radiance);

/// sRGB transfer function (IEC 61966-2-1) of a value in [0, 1] and its inverse.
float encode_srgb(float linear);
float decode_srgb(float encoded);

} // namespace relief
