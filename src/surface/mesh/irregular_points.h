// Quads beside irregular points and semi-sharp creases, cut smaller where one bicubic patch would not fit.
#pragma once

#include "surface/mesh/subdivision_mesh.h"

namespace relief {

/// Steps until fitted patches are near enough: docs/decisions/bicubic-base-patches.md has figures.
inline constexpr int kIsolationDepth = 3;

/// Cuts quads with one irregular corner, in full rings around it, into three, `depth` times: a smaller one at
/// the point and two beside it; regular sides stay whole. Quads along a semi-sharp crease become strips down
/// to where it has worn off: exact where it goes straight on, else cut towards the point as well. Where such
/// quads are too close, as below level 2, all of those at creases stay whole.
void cut_at_irregular_points(RefinedMesh& refined, int depth);

} // namespace relief
