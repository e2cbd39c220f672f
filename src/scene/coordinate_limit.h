// The largest coordinate of anything in a scene.
#pragma once

namespace relief {

/// Positions and displacements have no larger coordinate, so that squares of lengths stay finite.
inline constexpr float kLargestCoordinate = 1e18f;

} // namespace relief
