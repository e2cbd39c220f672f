// Engine and device options of all verbs that render.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "common/cli_app.h"
#include "relief/render.h"

namespace relief::cli {

/// Given options that only one engine supports.
struct EngineOptions {
    std::vector<std::string> vulkan_only, cpu_only;
};

/// Adds --engine, --device, --bottom, --threads and --isa; both structures must outlive parsing.
void add_engine_options(CLI::App& verb, EngineOptions& options, RenderSettings& settings);

/// As --isa has it.
std::string_view isa_name(Isa isa);

/// Rejects options of the other engine; sets the pipeline cache file of the Vulkan engine.
void complete_engine_options(const EngineOptions& options, RenderSettings& settings);

/// Pipeline cache file of a device in $XDG_CACHE_HOME/relief or ~/.cache/relief, which is created; empty if
/// neither is possible.
std::filesystem::path choose_pipeline_cache(int device);

} // namespace relief::cli
