// Options of `relief view`.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/cli_app.h"
#include "common/engine_options.h"
#include "relief/render.h"
#include "relief/scene.h"
#include "viewer/document.h"

namespace relief::viewer {

struct ViewerOptions {
    SceneInput input; ///< without a file: an empty window
    std::vector<std::string> mesh_only;
    cli::EngineOptions engine;
    RenderSettings settings;
    PictureDefaults given;
    std::filesystem::path script;
    std::optional<int> port; ///< of a server for browsers, in place of a window
};

/// Adds the options; `options` must outlive parsing.
void add_viewer_options(CLI::App& app, ViewerOptions& options);

/// Checks what needs no scene. Throws Error{usage}, and Error{bad_input} for files that are not there.
void complete_viewer_options(ViewerOptions& options);

} // namespace relief::viewer
