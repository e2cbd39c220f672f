// Samples a second of path-traced frames: the command `relief` of this build, and in turn with it that of
// another, as processes of their own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "common/report.h"

namespace relief::bench {

/// All sample scenes, then the default selection.
std::vector<std::string> frame_scene_names();
std::vector<std::string> default_frame_scenes();

/// Of the CPU engine, as --isa has them: AVX2 and AVX-512 where this machine has them, else the best.
std::vector<std::string> default_frame_isas();

struct FrameOptions {
    std::filesystem::path relief;   ///< the `relief` command
    std::filesystem::path baseline; ///< that of another build; empty: none
    std::filesystem::path folder;   ///< for scenes and output; not deleted
    RenderSettings settings;        ///< size, samples, engine, device and threads; the suite sets the rest
    int runs = 5;                   ///< measured runs of each program, >= 1
    std::vector<std::string> scenes = default_frame_scenes(); ///< of frame_scene_names()
    std::vector<std::string> isas = default_frame_isas();     ///< none for the Vulkan engine
};

/// Options of a smoke test.
FrameOptions make_quick_options(FrameOptions options);

/// Throws Error{usage} if a program is missing, Error{failed} with its command if it fails.
Value run_frame(const FrameOptions& options, const Report& report);

/// One measure a row.
Table make_frame_table(const Value& result);

/// Two tables in Markdown: speed and pictures, stages. What a program does not tell is "-".
std::string make_frame_page(const Value& result);

} // namespace relief::bench
