// Shading normals of points whose material has a normal map, and tangents of those that are anisotropic.
#pragma once

#include <span>

#include "cpu/tracer.h"

namespace relief::cpu {

/// Replaces the shading normals of points on materials with a normal map; `points` are those of `hits`, whose
/// normals lie on the side of the winding, as the new ones do with respect to the old.
void map_shading_normals(const PreparedScene& scene, std::span<const TraceHit> hits,
                         std::span<SurfacePoint> points);

/// Of points on anisotropic materials, world space, at right angles to the shading normal; before these are
/// mapped. Others stay as they are.
void find_tangents(const PreparedScene& scene, std::span<const TraceHit> hits,
                   std::span<const SurfacePoint> points, std::span<Vec3f> tangents);

} // namespace relief::cpu
