// Rays of the kinds that papers on structures measure, from a camera and from where its rays end.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "lab/trees.h"
#include "relief/scene.h"

namespace relief::bench {

/// Rays of one kind.
struct RaySet {
    std::string name; ///< primary, shadow, occlusion, diffuse
    HitKind kind = HitKind::closest;
    std::vector<Ray> rays;
    std::vector<uint32_t>
        parents; ///< of each ray the primary ray whose hit it starts at; empty for primary rays
};

/// Corners of each triangle, faces cut into fans in their order: the numbers of a TreeHit.
std::vector<std::array<uint32_t, 3>> list_triangles(const Mesh& mesh);

/// One ray through the middle of each pixel, row by row, through a pinhole.
RaySet make_primary_rays(const Camera& camera, int width, int height);

/// By the cosine about a unit normal, the same for the same number.
Vec3f draw_cosine_direction(const Vec3f& normal, uint32_t number);

/// From each hit of the primary rays: a shadow ray along `to_light`, an occlusion ray of a tenth of the
/// mesh's diagonal, and a diffuse ray; the latter two by the cosine about the normal on the side of the ray,
/// the same for every run.
std::vector<RaySet> make_secondary_rays(const Mesh& mesh, const RaySet& primary,
                                        const std::vector<TreeHit>& hits, const Vec3f& to_light);

} // namespace relief::bench
