// Limits of the textures of material inputs, and the range that a texture scales a number to.
#pragma once

#include <cstddef>

#include "relief/material_inputs.h"

namespace relief {

/// Numbers of a material with layers that may have textures at once: the albedo table has an axis for each.
inline constexpr size_t kMaxLayerTextures = 4;
/// The same of a material whose roughness has a direction, which is one more axis.
inline constexpr size_t kMaxStretchedTextures = 2;

/// Least and greatest values that a texture multiplies a number by.
struct FactorRange {
    float lower = 1, upper = 1;
};
FactorRange find_factors(const InputTexture& texture);

} // namespace relief
