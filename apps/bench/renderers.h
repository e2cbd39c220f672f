// Renders one scene folder with Cycles and with the command `relief`, each as a process of its own.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "common/report.h"
#include "relief/render.h"

namespace relief::bench {

/// Width in texels of the importance map of the sky: Blender's default, 4096, is finer than the sky image and
/// takes seconds to build.
inline constexpr int kImportanceMap = 512;
inline constexpr int kDefaultImportanceMap = 0; ///< the script's value for Blender's default

/// What both are asked for.
struct RenderTask {
    int samples = 1, bounces = 0;
    int importance_map = kImportanceMap;
    bool is_denoised = false;      ///< Open Image Denoise, with albedo and normal
    int seed = 1;                  ///< >= 0
    std::filesystem::path picture; ///< EXR without the background; empty: none is kept
};

/// Measures of one render of one program.
using Measures = std::map<std::string, double>;

/// Each measure of at least one run, which all have the same, by its name as summarize() describes it.
Value summarize_measures(const std::vector<Measures>& runs);

/// Command that runs a Python script in Blender, which follows it; Blender as a module serves as well. Throws
/// Error{usage} where neither `blender` nor a `python3` with the package bpy is in PATH.
std::vector<std::string> find_blender();

/// As WxH.
std::string describe_size(const RenderSettings& settings);
/// Those asked for, or all of the machine.
int count_threads(const RenderSettings& settings);

class Renderers {
  public:
    /// `relief`: the command; `folder`: for the script and other files, made when missing; `size`: WxH.
    /// Throws Error{usage} where neither `blender` nor a `python3` with the package bpy is in PATH.
    Renderers(std::filesystem::path relief, std::filesystem::path folder, std::string size, int threads);

    /// {images_s, prepare_s, first_sample_s, render_s, with_reading_s, cycles_own_peak_bytes,
    /// resident_peak_bytes}. Throws Error{failed} with the end of the log where the program fails.
    Measures render_with_cycles(const std::filesystem::path& scene, const RenderTask& task);
    /// {load_s, prepare_s, first_sample_s, render_s, denoise_s, with_reading_s, with_reading_and_writing_s,
    /// resident_peak_bytes}. Throws Error{failed} likewise.
    Measures render_with_relief(const std::filesystem::path& scene, const RenderTask& task);

    const std::string& blender_version() const { return blender_version_; } ///< of the last render
    const Value& device() const { return device_; }                         ///< of the last render by Relief

  private:
    std::vector<std::string> blender_; ///< program and arguments before those of the script
    std::filesystem::path relief_, folder_;
    std::string size_, threads_, blender_version_;
    Value device_;
};

} // namespace relief::bench
