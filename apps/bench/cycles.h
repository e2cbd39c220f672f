// Compares the CPU engine with Blender's Cycles (adaptive subdivision, vector displacement) on the same
// scenes, as separate alternating processes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "common/report.h"

namespace relief::bench {

/// All scenes of the suite, then the default selection.
std::vector<std::string> cycles_scene_names();
std::vector<std::string> default_cycles_scenes();

struct CyclesOptions {
    std::filesystem::path relief; ///< the `relief` command
    std::filesystem::path folder; ///< for scenes and output; not deleted
    RenderSettings settings;      ///< size, threads and instruction set; the suite sets the rest
    int runs = 3;                 ///< measured runs, >= 1
    int samples = 16;             ///< of the long renders and the compared pictures
    std::vector<std::string> scenes = default_cycles_scenes();
};

/// Options of a smoke test.
CyclesOptions make_quick_options(CyclesOptions options);

/// The scene with white diffuse surfaces lit by its sky only: the common subset of both renderers.
Scene make_cycles_scene(const std::string& name);

/// Source of the script that Blender runs on a folder written by save_scene, and of the one for the suite
/// characters, which imports it as the module cycles_scene.
const char* cycles_script();
const char* character_script();

/// Compares two pictures: {hit_pixels, masks_differ, brightness_ratio}.
Value compare_with_cycles(const Image& relief, const Image& cycles);

/// Throws Error{usage} if `blender` is not found, Error{failed} if a program fails or the pictures are not
/// equivalent; then nothing is reported.
Value run_cycles(const CyclesOptions& options, const Report& report);

} // namespace relief::bench
