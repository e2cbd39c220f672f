// Quads around irregular points cut smaller and smaller, where one bicubic patch would be far from the limit
// surface.
#pragma once

#include "surface/subdivision_mesh.h"

namespace relief {

/// Steps that bring fitted patches near enough; docs/decisions/bicubic-base-patches.md has the measurements.
inline constexpr int kIsolationDepth = 3;

/// Cuts every quad with one irregular corner, and none but such quads around that point, into three, `depth`
/// times: a smaller one at the point and two between it and the far sides. Sides between regular points stay
/// whole.
void isolate_irregular_points(RefinedMesh& refined, int depth);

} // namespace relief
