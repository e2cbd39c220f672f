#include "picture_settings.h"

#include <filesystem>
#include <vector>

#include "common/inputs.h"
#include "relief/aim.h"
#include "relief/io.h"
#include "render_warnings.h"

namespace relief::cli {

namespace {

/// The camera of a mesh alone is made for landscape pictures and its own angle: others frame it anew.
AimOptions choose_aim(const RenderOptions& options, const ImageSettings& image) {
    AimOptions aim = options.aim.scene;
    const bool fits_already = image.width >= image.height && !aim.fov_degrees;
    if (is_mesh_file(options.input) && !aim.from && !aim.view && !fits_already) aim.frame_all = true;
    return aim;
}

} // namespace

RenderSettings check_picture(const RenderOptions& options, Scene& scene) {
    if (options.tile && get_lower_extension(options.output) == ".png")
        scene.warnings.emplace_back("a tile as a PNG cannot be merged: name an .exr");
    const std::vector<std::string> files = list_files(scene);
    keep_files(files, options.output), keep_files(files, options.statistics_file);
    keep_files(files, options.aim.saved_scene);
    for (const std::string& film : list_films(options.checkpoint, options.output)) keep_files(files, film);
    RenderSettings settings = make_settings(options, scene.picture);
    check_display(options.aim.display, options.output);
    apply_background(options.aim, options.output, settings.image);
    return settings;
}

RenderSettings prepare_picture(const RenderOptions& options, Scene& scene) {
    add_assumption_warnings(scene, options.progress.is_quiet, is_mesh_file(options.input));
    const RenderSettings settings = check_picture(options, scene);
    refuse_empty_scene(scene, options.input);
    aim_scene(scene, choose_aim(options, settings.image),
              float(settings.image.width) / float(settings.image.height));
    return settings;
}

} // namespace relief::cli
