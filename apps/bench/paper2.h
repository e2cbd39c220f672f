// Compares builders and traversals on triangle meshes: those of Murguia et al. 2013 (Bit-Trail Traversal for
// Stackless LBVH on DirectCompute) and current ones.
#pragma once

#include <string>
#include <vector>

#include "bench/measure.h"
#include "common/report.h"
#include "lab/scenes/structure_scenes.h"
#include "relief/render.h"

namespace relief::bench {

struct Paper2Options {
    RenderSettings settings; ///< engine, device, threads, and size of the grid of primary rays
    int runs = 5;            ///< measured runs after a warm-up, >= 1
    std::vector<std::string> scenes = structure_scene_names();
    std::vector<Scene> meshes; ///< user scenes; the first mesh of each is measured
    MeshDetail detail = MeshDetail::full;
};

/// Options of a smoke test.
Paper2Options make_quick_options(Paper2Options options);

/// Throws Error{failed}, without a report, if two combinations disagree about a hit.
Value run_paper2(const Paper2Options& options, const Report& report);

} // namespace relief::bench
