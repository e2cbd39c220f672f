// Options of `relief render`, validated as far as possible without the scene.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "aim_options.h"
#include "checkpoint.h"
#include "common/cli_app.h"
#include "common/engine_options.h"
#include "common/progress.h"
#include "relief/denoise.h"
#include "relief/io.h"
#include "relief/render.h"

namespace relief::cli {

struct Tile {
    int index = 0, count = 1;
};

struct RenderOptions {
    std::filesystem::path input, output, statistics_file;
    std::string edits; ///< file of edits, "-": standard input; empty: none
    MeshSceneOptions mesh;
    std::vector<std::string> mesh_only; ///< given options that only meshes support
    AimArguments aim;
    EngineOptions engine;
    RenderSettings settings; ///< from the command line; picture defaults apply where `given` is empty
    PictureDefaults given;   ///< picture settings given on the command line
    std::optional<std::pair<int, int>> samples;
    std::optional<Tile> tile;
    std::optional<std::pair<int, int>> pixel;
    CheckpointOptions checkpoint;
    std::vector<int> frames;     ///< empty: those of the scene file
    bool skips_existing = false; ///< frames whose pictures are there
    bool is_denoised = false;
    std::shared_ptr<const Denoiser> denoiser; ///< where is_denoised
    ProgressOptions progress;
    bool is_verbose = false, is_strict = false;
};

/// Adds the options; `options` must outlive parsing.
void add_render_options(CLI::App& verb, RenderOptions& options);

/// Checks everything that does not need the scene: files and conflicting options. Fills in the default output
/// name.
void complete_render_options(RenderOptions& options);

/// Throws Error{usage} for options that are of one picture.
void check_series(const RenderOptions& options);

/// Final settings: command line, then scene file, then defaults; with crop, tile and sample range applied.
RenderSettings make_settings(const RenderOptions& options, const PictureDefaults& picture);

/// Tile `tile` of a window: horizontal bands of whole rows, of nearly equal height.
Window make_tile_window(const Window& window, const Tile& tile);

} // namespace relief::cli
