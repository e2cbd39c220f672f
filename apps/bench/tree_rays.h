// Kinds of rays measured in papers on acceleration structures, from a camera and from its hits.
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
        parents; ///< index of the primary ray whose hit each ray starts at; empty for primary rays
};

/// Corners of each triangle, faces as fans in order; indexed by TreeHit::primitive.
std::vector<std::array<uint32_t, 3>> list_triangles(const Mesh& mesh);

/// One pinhole ray through the centre of each pixel, row by row.
RaySet make_primary_rays(const Camera& camera, int width, int height);

/// Cosine-distributed direction about a unit normal; a function of the number.
Vec3f draw_cosine_direction(const Vec3f& normal, uint32_t number);

/// From each hit of the primary rays: a shadow ray along `to_light`, an occlusion ray of a tenth of the
/// mesh's diagonal, and a diffuse ray; the latter two cosine distributed about the normal on the ray's side;
/// deterministic.
std::vector<RaySet> make_secondary_rays(const Mesh& mesh, const RaySet& primary,
                                        const std::vector<TreeHit>& hits, const Vec3f& to_light);

} // namespace relief::bench
