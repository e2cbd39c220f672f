// What other programs ask of a hit beside its place: computed from the place alone, so that it does not
// matter which engine found it.
#pragma once

#include <span>

#include "prepare/prepared_scene.h"
#include "relief/intersect.h"

namespace relief {

/// `wanted`: bits of HitAttribute. Spans of equal length; in parallel.
void compute_hit_attributes(const PreparedScene& scene, uint32_t wanted, std::span<const RayHit> hits,
                            std::span<HitAttributes> attributes);

} // namespace relief
