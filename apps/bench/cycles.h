// Blender's Cycles with adaptive subdivision and vector displacement beside the CPU engine: the same scene,
// both as programs of their own, in turn.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "common/report.h"

namespace relief::bench {

/// All that the suite knows, then those that it measures unless told otherwise.
std::vector<std::string> cycles_scene_names();
std::vector<std::string> default_cycles_scenes();

struct CyclesOptions {
    std::filesystem::path relief; ///< the command that renders for us
    std::filesystem::path folder; ///< for the scenes and what the programs write; left behind
    RenderSettings settings;      ///< size, threads and instruction set; all else is the suite's
    int runs = 3;                 ///< that count; >= 1
    int samples = 16;             ///< of the long renders and of the pictures that are compared
    std::vector<std::string> scenes = default_cycles_scenes();
};

/// Options of a run that only shows that everything works.
CyclesOptions make_quick_options(CyclesOptions options);

/// The scene with white diffuse surfaces under its sky alone: what both renderers have in common.
Scene make_cycles_scene(const std::string& name);

/// The text of the script that Blender runs over a folder that save_scene wrote.
const char* cycles_script();

/// How far two pictures are of the same thing: {hit_pixels, masks_differ, brightness_ratio}.
Value compare_with_cycles(const Image& relief, const Image& cycles);

/// Throws Error{usage} where no `blender` is found, Error{failed} where a program fails or the pictures are
/// not of the same thing: then nothing is reported.
Value run_cycles(const CyclesOptions& options, const Report& report);

} // namespace relief::bench
