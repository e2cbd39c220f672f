// Options of `relief render` that change what is seen of a scene: camera, light, ground, background, display.
#pragma once

#include <filesystem>
#include <string>

#include "common/cli_app.h"
#include "relief/aim.h"
#include "relief/render.h"

namespace relief::cli {

struct AimArguments {
    AimOptions scene;
    std::string background; ///< empty: the environment; "transparent"; "#rrggbb"
    std::string exposure;   ///< empty, EV as a number, or "auto"
    std::string tone_map;   ///< name of a display transform; empty: the default
    std::string png_bits;   ///< "8", "16" or empty
    int turntable = 0;      ///< pictures of one turn; 0: one picture that is not turned
    std::filesystem::path saved_scene;
};

/// Adds the options; `arguments` must outlive parsing.
void add_aim_options(CLI::App& verb, AimArguments& arguments);

/// Sets the background of camera rays for a picture of this name; throws Error{usage} for a display that goes
/// with .png alone, Error{failed} for one whose libraries cannot be loaded.
void apply_background(const AimArguments& arguments, const std::filesystem::path& output,
                      ImageSettings& image);

/// Adds the header entries that PNG files, and those made from the picture later, are shown by.
void add_display_entries(const AimArguments& arguments, const std::filesystem::path& output, Image& image);

/// FILE.0007.EXT: picture `index` of a turntable, from 0.
std::filesystem::path name_turn(const std::filesystem::path& output, int index);

} // namespace relief::cli
