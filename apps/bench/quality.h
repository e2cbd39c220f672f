// Error against time: the CPU engine and Cycles on the same scenes, with and without a denoiser.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "common/report.h"

namespace relief::bench {

std::vector<std::string> default_quality_scenes();

struct QualityOptions {
    std::filesystem::path relief; ///< the `relief` command
    std::filesystem::path folder; ///< for scenes and output; not deleted
    RenderSettings settings;      ///< size and threads; the suite sets the rest
    int runs = 1;                 ///< measured runs, >= 1: pictures are the same, times are not
    int most_samples = 64;        ///< of Cycles: 1, 4, 16 ... up to this
    int reference_samples = 1024; ///< of each program's own reference, with another seed
    std::vector<std::string> scenes = default_quality_scenes(); ///< of cycles_scene_names()
};

/// Options of a smoke test.
QualityOptions make_quick_options(QualityOptions options);

/// Throws Error{usage} if Blender is not found, Error{failed} if a program fails. Without a library to
/// denoise with, Relief's denoised pictures are left out and the result says why.
Value run_quality(const QualityOptions& options, const Report& report);

} // namespace relief::bench
