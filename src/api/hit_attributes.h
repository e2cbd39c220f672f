// Optional attributes of hits, computed from the position alone, so that they do not depend on the engine.
#pragma once

#include <span>

#include "prepare/prepared_scene.h"
#include "relief/intersect.h"

namespace relief {

/// `wanted`: bits of HitAttribute. Spans of equal length; runs in parallel.
void compute_hit_attributes(const PreparedScene& scene, uint32_t wanted, std::span<const RayHit> hits,
                            std::span<HitAttributes> attributes);

} // namespace relief
