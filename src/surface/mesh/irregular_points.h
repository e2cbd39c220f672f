// Quads beside irregular points and semi-sharp creases, cut smaller where one bicubic patch would not fit.
#pragma once

#include "surface/mesh/subdivision_mesh.h"

namespace relief {

/// Steps until fitted patches are near enough: docs/decisions/bicubic-base-patches.md has figures.
inline constexpr int kIsolationDepth = 3;

/// Cuts every quad with one irregular corner, and none but such quads around that point, into three, `depth`
/// times: a smaller one at the point and two between it and the far sides. Sides between regular points stay
/// whole. Quads along a semi-sharp crease become strips along it, down to the width at which it has worn off:
/// where the crease goes on straight the patches are exact; where it ends, turns or meets another, they are
/// cut towards that point as well. Where such quads come too close to each other anywhere on the mesh, as
/// below level 2, all of those at creases stay whole.
void cut_at_irregular_points(RefinedMesh& refined, int depth);

} // namespace relief
