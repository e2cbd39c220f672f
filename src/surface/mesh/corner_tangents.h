// Tangents that normal maps of materials go through, on surfaces of every kind.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "surface/patch/surface.h"

namespace relief {

/// One a corner of each patch, packed as PackedFrame::tangent. Those that the surface is displaced through,
/// where they are unit vectors; else MikkTSpace of the patches, on the normals of the surface or of its
/// faces. The surface has uvs; where these have no area any tangent will do.
std::vector<std::array<uint32_t, 4>> make_corner_tangents(const Surface& surface);

/// Tangent of a patch at (u, v), object space, not of unit length; `surface.corner_tangents` is filled.
Vec3f blend_tangents(const Surface& surface, uint32_t patch, const Vec2f& at);
/// -1 or 1: the sign of the bitangent with a normal on the side of the winding.
float find_handedness(const Surface& surface, uint32_t patch);
/// Interpolated vertex normal of a displaced surface without its displacement, object space.
Vec3f blend_base_normals(const Surface& surface, uint32_t patch, const Vec2f& at);

} // namespace relief
