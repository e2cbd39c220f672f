// Builders and traversals over triangle meshes, side by side: what Murguia et al. 2013 (Bit-Trail Traversal
// for Stackless LBVH on DirectCompute) measure, and what stands beside it today.
#pragma once

#include <string>
#include <vector>

#include "bench/measure.h"
#include "common/report.h"
#include "lab/scenes/structure_scenes.h"
#include "relief/render.h"

namespace relief::bench {

struct Paper2Options {
    RenderSettings settings; ///< engine, device, threads, and width and height of the grid of primary rays
    int runs = 5;            ///< that count, after one that does not; >= 1
    std::vector<std::string> scenes = structure_scene_names();
    std::vector<Scene> meshes; ///< the user's: each with one mesh or more, of which the first is measured
    MeshDetail detail = MeshDetail::full;
};

/// Options of a run that only shows that everything works.
Paper2Options make_quick_options(Paper2Options options);

/// Throws Error{failed} where any two combinations disagree about a hit: then nothing is reported.
Value run_paper2(const Paper2Options& options, const Report& report);

} // namespace relief::bench
