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

inline constexpr const char* kViewerDescription =
    "Look at a scene, turn it, change how its maps are meant, paint on them";

struct ViewerOptions {
    SceneInput input; ///< without a file: an empty window
    std::vector<std::string> mesh_only;
    cli::EngineOptions engine;
    RenderSettings settings;
    PictureDefaults given;
    std::filesystem::path script;
    bool is_quiet = false;   ///< a script prints no times
    std::optional<int> port; ///< of a server for browsers, in place of a window
};

/// Adds the options; `options` must outlive parsing.
void add_viewer_options(CLI::App& app, ViewerOptions& options);

/// Checks what needs no scene. Throws Error{usage}, and Error{bad_input} for files that are not there.
void complete_viewer_options(ViewerOptions& options);

} // namespace relief::viewer
