// Plain triangle meshes: the CPU engine's tree against Embree's, in one process, on one thread, interleaved.
#pragma once

#include <vector>

#include "bench/measure.h"
#include "common/report.h"
#include "lab/scenes/structure_scenes.h"
#include "relief/render.h"
#include "relief/scene.h"

namespace relief::bench {

struct TrianglesOptions {
    int runs = 7;                         ///< measured runs after a warm-up, >= 1
    int width = 640, height = 480;        ///< primary rays; each hit spawns one diffuse ray
    Isa isa = Isa::best;                  ///< of the CPU engine
    MeshDetail detail = MeshDetail::full; ///< of body and hall, which are always measured
    std::vector<Scene> meshes;            ///< of one mesh each, measured in addition
};

TrianglesOptions make_quick_options(TrianglesOptions options);

/// Builds both trees, compares all hits, then measures. Throws Error as TracerProbe does.
Value run_triangles(const TrianglesOptions& options, const Report& report);

} // namespace relief::bench
