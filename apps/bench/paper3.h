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
    RenderSettings settings; ///< engine, device, size, threads; all else is the suite's
    int runs = 5;            ///< that count; >= 1
    int warm_up_runs = 1;    ///< before them
    std::vector<std::string> scenes = paper3_scenes();
    std::vector<Scene> meshes; ///< the user's
    MeshDetail detail = MeshDetail::full;
};

/// Options of a run that only shows that everything works.
Paper3Options make_quick_options(Paper3Options options);

/// What a device cannot do, or has no memory for, is a result: the reason stands in the place of figures.
Value run_paper3(const Paper3Options& options, const Report& report);

} // namespace relief::bench
