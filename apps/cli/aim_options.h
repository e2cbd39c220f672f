// Options of `relief render` that change what is seen of a scene: camera, light, ground, background, display.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/cli_app.h"
#include "relief/aim.h"
#include "relief/render.h"

namespace relief::cli {

struct DisplayArguments {
    std::string exposure;    ///< empty, EV as a number, or "auto"
    std::string tone_map;    ///< name of a display transform; empty: the default
    std::string png_bits;    ///< "8", "16" or empty
    std::string color_space; ///< of the file; empty: linear Rec.709, or that of the parts that are joined
};

struct AimArguments {
    AimOptions scene;
    std::string ground;     ///< as it was given
    std::string background; ///< empty: the environment; "transparent"; "#rrggbb"
    DisplayArguments display;
    int turntable = 0; ///< pictures of one turn; 0: one picture that is not turned
    std::filesystem::path saved_scene;
};

/// Adds the options; `arguments` must outlive parsing.
void add_aim_options(CLI::App& verb, AimArguments& arguments);

/// Adds --exposure, --tonemap, --png-bits and --color-space; `arguments` must outlive parsing.
void add_display_options(CLI::App& verb, DisplayArguments& arguments);

/// Throws Error{usage} for a display of a picture that has none, Error{failed} for one whose libraries cannot
/// be loaded.
void check_display(const DisplayArguments& arguments, const std::filesystem::path& output);

/// Sets the background of camera rays for a picture of this name; throws Error{usage} where its format has no
/// alpha that it needs.
void apply_background(const AimArguments& arguments, const std::filesystem::path& output,
                      ImageSettings& image);

/// Adds the header entries that PNG files, and those made from the picture later, are shown by, and the
/// colour space of an EXR file.
void add_display_entries(const DisplayArguments& arguments, Image& image);

/// Those, and the background.
void add_picture_entries(const AimArguments& arguments, const std::filesystem::path& output, Image& image);

/// Background and display as options of the command: what a scene file does not hold.
std::vector<std::string> list_picture_options(const AimArguments& arguments);

/// FILE.0007.EXT: picture `index` of a turntable, from 0.
std::filesystem::path name_turn(const std::filesystem::path& output, int index);

} // namespace relief::cli
