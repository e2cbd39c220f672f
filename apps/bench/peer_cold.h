// Cold first images: scene and maps are in memory, nothing has been built.
#pragma once

#include <vector>

#include "bench/peer_rays.h"
#include "bench/peer_scene.h"
#include "common/report.h"

namespace relief::bench {

/// {relief, triangles, grid, subdivision}, each with seconds of its parts (prepare, tessellate, build,
/// primary, occlusion, diffuse), of the images first_primary, first_occlusion and first_diffuse, bytes, and
/// peak resident memory; interleaved.
Value measure_cold(const PeerScene& scene, const std::vector<PeerRays>& sets);

} // namespace relief::bench
