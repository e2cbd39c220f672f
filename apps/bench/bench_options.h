// Options of `relief bench`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/cli_app.h"
#include "common/engine_options.h"
#include "common/progress.h"
#include "relief/render.h"

namespace relief::bench {

struct BenchOptions {
    std::string suite = "paper1";
    std::filesystem::path folder; ///< output folder; empty: the name of the suite
    cli::EngineOptions engine;
    RenderSettings settings; ///< engine settings; the size is below
    std::optional<std::pair<int, int>> size;
    std::vector<std::string> scenes; ///< none: all of the suite
    std::vector<std::string> meshes, scene_files;
    std::vector<std::string> maps;     ///< of the meshes, in their order; or none
    std::string map_space;             ///< of all maps; empty: as the files say
    std::vector<std::string> blenders; ///< programs; none: the one in PATH
    std::optional<int> runs, spp;
    std::filesystem::path baseline; ///< another build of the command; empty: none
    std::optional<uint64_t> tessellated_limit_bytes;
    std::optional<int> level;
    std::vector<int> levels; ///< none: all of the suite
    bool is_quick = false;
    cli::ProgressOptions progress;
};

/// Adds all options; `options` must outlive parsing.
void add_bench_options(CLI::App& app, BenchOptions& options);

/// Given options that only some suites support.
std::vector<std::string_view> list_given(const BenchOptions& options);

} // namespace relief::bench
