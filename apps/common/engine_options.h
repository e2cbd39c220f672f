// Which engine renders, and on which device: options of every verb that renders.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/cli_app.h"
#include "relief/render.h"

namespace relief::cli {

/// Options given that only one engine takes.
struct EngineOptions {
    std::vector<std::string> vulkan_only, cpu_only;
};

/// Adds --engine, --device, --bottom, --threads and --isa; both structures must outlive the
/// parsing.
void add_engine_options(CLI::App& verb, EngineOptions& options, RenderSettings& settings);

/// Refuses options of the other engine; gives the Vulkan engine its file of compiled kernels.
void complete_engine_options(const EngineOptions& options, RenderSettings& settings);

/// Where compiled kernels are kept for a device: in $XDG_CACHE_HOME/relief or ~/.cache/relief, which is made;
/// empty where neither can be.
std::filesystem::path choose_pipeline_cache(int device);

} // namespace relief::cli
