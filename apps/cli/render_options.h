// What `relief render` was asked for, checked as far as that is possible without the scene.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/cli_app.h"
#include "common/engine_options.h"
#include "progress.h"
#include "relief/io.h"
#include "relief/render.h"

namespace relief::cli {

struct Tile {
    int index = 0, count = 1;
};

struct RenderOptions {
    std::filesystem::path input, output, statistics_file;
    std::string edits; ///< file of edits to follow, "-": standard input; empty: none
    MeshSceneOptions mesh;
    std::vector<std::string> mesh_only; ///< options given that only a mesh takes
    EngineOptions engine;
    RenderSettings settings; ///< of the command line; picture defaults apply where `given` is empty
    PictureDefaults given;   ///< picture settings that the command line holds
    std::optional<std::pair<int, int>> samples;
    std::optional<Tile> tile;
    std::optional<std::pair<int, int>> pixel;
    ProgressStyle progress = ProgressStyle::automatic;
    bool is_quiet = false, is_verbose = false, is_strict = false;
};

/// Adds the options; `options` must outlive the parsing.
void add_render_options(CLI::App& verb, RenderOptions& options);

/// Checks what does not need the scene: files, and options that exclude each other. Fills the default output
/// name.
void complete_render_options(RenderOptions& options);

/// Settings of the render: command line, then scene file, then defaults; crop, tile and sample range worked
/// in.
RenderSettings make_settings(const RenderOptions& options, const PictureDefaults& picture);

/// Rows of tile `tile` of a window: horizontal bands of whole rows, as equal as they can be.
Window make_tile_window(const Window& window, const Tile& tile);

} // namespace relief::cli
