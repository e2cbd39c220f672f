// Structures, traversals and render methods of the paper on ray tracing for mobile devices (GRAPP 2019), on
// triangle meshes and on displaced surfaces.
#pragma once

#include <string>
#include <vector>

#include "bench/measure.h"
#include "common/report.h"
#include "lab/scenes/structure_scenes.h"
#include "relief/render.h"

namespace relief::bench {

/// Triangle meshes, then sample scenes with displaced surfaces.
std::vector<std::string> paper3_scenes();

struct Paper3Options {
    RenderSettings settings; ///< engine, device, size, threads; the suite sets the rest
    int runs = 5;            ///< measured runs, >= 1
    int warm_up_runs = 1;    ///< before the measured runs
    std::vector<std::string> scenes = paper3_scenes();
    std::vector<Scene> meshes; ///< user scenes
    MeshDetail detail = MeshDetail::full;
};

/// Options of a smoke test.
Paper3Options make_quick_options(Paper3Options options);

/// Missing features or memory of a device are results: the reason replaces the figures.
Value run_paper3(const Paper3Options& options, const Report& report);

} // namespace relief::bench
