#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/parallel.h"
#include "commands.h"
#include "common/console.h"
#include "common/denoiser_search.h"
#include "common/exit_codes.h"
#include "common/explain_pixel.h"
#include "common/inputs.h"
#include "common/mesh_reader.h"
#include "common/values.h"
#include "finish_picture.h"
#include "interrupt.h"
#include "picture_settings.h"
#include "reading_notice.h"
#include "relief/error.h"
#include "relief/io.h"
#include "relief/render.h"
#include "relief/shot.h"
#include "render_frames.h"
#include "render_motion.h"
#include "render_options.h"
#include "render_series.h"
#include "render_warnings.h"

namespace relief::cli {

namespace {

void refuse_picture(const RenderOptions& options) {
    if (is_picture_name(options.input))
        throw Error(ErrorKind::usage, {"this is a picture, neither a scene nor a mesh", options.input,
                                       "a map goes with its mesh: relief render MESH --vdm MAP"});
}

/// What a resumed picture has of its own, beyond what this render was asked for.
void tell_of_earlier_samples(const RenderResult& result, const ImageSettings& image) {
    const std::string& range = result.image.metadata.at("relief:samples"); // "A:B"
    const int most = std::stoi(range.substr(range.find(':') + 1)) - image.first_sample;
    if (result.statistics.camera_rays == 0 && image.noise > 0)
        print_error("relief: no samples are added: pixels have {} already, or as little noise as asked for\n",
                    image.spp);
    else if (result.statistics.camera_rays == 0)
        print_error("relief: the picture had {} samples already: --spp {} adds none\n", result.whole_samples,
                    image.spp);
    if (image.noise > 0 && most > image.spp)
        print_error("relief: noisy pixels keep the up to {} samples that they had, more than --spp {}\n",
                    most, image.spp);
    const bool is_uneven = image.noise == 0 && image.time_limit_s == 0 && most > result.whole_samples;
    if (is_uneven)
        print_error(
            "relief: pixels of the unfinished pass keep the {} samples that they had: --spp {} brings "
            "all others there\n",
            most, most);
}

/// The scene file of a scene that may move, and the frame that it was loaded at; null: a still one.
struct Source {
    Shot* shot = nullptr;
    int frame = 1;
};

int render_picture(const RenderOptions& options, const RenderSettings& given, Scene scene,
                   const Source& source, const PendingTimes& waiting) {
    catch_interrupts();
    const RenderSettings settings = reserve_time(options, given, waiting);
    const std::filesystem::path& output = options.output;
    RenderResult result;
    ToldWarnings told;
    FilmKeeper keeper(options.checkpoint, output);
    {
        RenderWatcher watcher(options, told); // its end prints the last line
        result = source.shot ? render_shot(*source.shot, source.frame, std::move(scene), settings, &watcher,
                                           keeper.checkpoints())
                             : render(std::move(scene), settings, &watcher, keeper.checkpoints());
        if (watcher.is_refused()) return kExitWarnings;
    }
    if (!options.checkpoint.resumed.empty() && result.is_complete)
        tell_of_earlier_samples(result, settings.image);
    const int exit_code = finish_picture(options, settings, output, waiting, result, told);
    return exit_code == kExitDone && keeper.has_failed() ? int(ErrorKind::failed) : exit_code;
}

/// The scene as it is rendered, for --save-scene.
void save_aimed_scene(const RenderOptions& options, const RenderSettings& settings, Scene scene) {
    const ImageSettings& image = settings.image;
    scene.picture = {image.width, image.height, image.spp, image.bounces, image.seed, scene.picture.fps};
    const std::vector<std::string> words = list_picture_options(options.aim);
    save_scene_copy(scene, options.input, options.mesh, options.aim.saved_scene, words);
    print_output("wrote {}{}\n", options.aim.saved_scene.string(),
                 words.empty() ? std::string()
                               : fmt::format("; a scene does not hold {}: add that when you render it",
                                             fmt::join(words, " ")));
}

int render_scene(const RenderOptions& options, Scene scene, const Source& source, double start) {
    const double load_s = get_seconds() - start;
    const RenderSettings settings = prepare_picture(options, scene);
    if (!options.aim.saved_scene.empty()) save_aimed_scene(options, settings, scene);
    const PendingTimes waiting{start, load_s};
    if (!options.edits.empty()) return render_edits(options, settings, std::move(scene), waiting);
    if (options.aim.turntable > 0) return render_turns(options, settings, std::move(scene), waiting);
    if (!options.pixel) return render_picture(options, settings, std::move(scene), source, waiting);
    print_output("{}", explain_pixel(scene, settings, options.pixel->first, options.pixel->second).text);
    if (!options.progress.is_quiet) print_warnings(scene.warnings, is_mesh_file(options.input));
    return options.is_strict && !scene.warnings.empty() ? kExitWarnings : kExitDone;
}

/// The options with the frame's number in the names of the picture and of that which is resumed. Without a
/// frame only `####` becomes a number, that of the first frame.
RenderOptions name_pictures(const RenderOptions& options, std::optional<int> frame) {
    RenderOptions one = options;
    if (options.pixel) return one;
    const auto name = [&](const std::filesystem::path& file) {
        return frame || is_frame_pattern(file) ? name_frame(file, frame.value_or(1)) : file;
    };
    one.output = name(options.output);
    if (!options.checkpoint.resumed.empty())
        one.checkpoint.resumed = name(options.checkpoint.resumed).string();
    check_checkpoint(one.checkpoint, one.output);
    return one;
}

template <class Load> Scene read_scene(const RenderOptions& options, const Load& load) {
    return with_scene_hint(options, [&] { return read_with_notice(options.progress, options.input, load); });
}

Scene read_mesh_scene(const RenderOptions& options) {
    return read_with_notice(options.progress, options.input,
                            [&] { return load_mesh_scene(options.input, options.mesh); });
}

/// A picture of one frame, or of the file as it is where there is none. The shot is let go before a still one
/// is rendered: it holds the text of the scene, and textures that a render would free.
int render_frame(const RenderOptions& options, std::optional<Shot>& shot, std::optional<int> frame,
                 double start) {
    const RenderOptions one = name_pictures(options, frame);
    Scene scene = read_scene(options, [&] { return shot->load(frame.value_or(1)); });
    const bool is_still = options.pixel || !options.edits.empty() || options.aim.turntable > 0 ||
                          !is_moving(*shot, scene.camera);
    if (is_still) {
        shot.reset();
        return render_scene(one, std::move(scene), {}, start);
    }
    check_motion(options);
    return render_scene(one, std::move(scene), {&*shot, frame.value_or(1)}, start);
}

/// One picture, or those of all frames of the scene file or the command line.
int render_file(const RenderOptions& options, double start) {
    refuse_picture(options);
    std::optional<Shot> shot;
    with_scene_hint(options, [&] { shot.emplace(options.input, make_mesh_reader()); });
    const std::vector<int> frames = options.frames.empty() ? shot->frames() : options.frames;
    if (frames.empty() && options.skips_existing)
        throw Error(ErrorKind::usage, {"the scene file names no frames", "--skip-existing", "--frames 1-24"});
    if (frames.empty()) return render_frame(options, shot, std::nullopt, start);
    if (options.pixel || (frames.size() == 1 && !options.skips_existing))
        return render_frame(options, shot, frames.front(), start);
    check_series(options);
    const auto load = [&](int frame) {
        Scene scene = read_scene(options, [&] { return shot->load(frame); });
        if (is_moving(*shot, scene.camera)) check_motion(options);
        const RenderSettings settings = prepare_picture(options, scene);
        return std::pair(std::move(scene), settings);
    };
    const auto check = [&](Scene& scene) { return check_picture(options, scene); };
    return render_frames(options, {*shot, load, check}, frames, {start, 0});
}

int render_mesh(const RenderOptions& options, double start) {
    const bool is_one = options.aim.turntable == 0 && options.edits.empty();
    const RenderOptions one = is_one ? name_pictures(options, std::nullopt) : options;
    return render_scene(one, read_mesh_scene(options), {}, start);
}

} // namespace

Command add_render(CLI::App& verb) {
    const auto options = std::make_shared<RenderOptions>();
    add_render_options(verb, *options);
    return [options] {
        const double start = get_seconds();
        complete_render_options(*options);
        // Before the scene is read: a render would be in vain without it.
        if (options->is_denoised)
            options->denoiser =
                std::make_shared<const Denoiser>(load_denoiser(options->settings.device.threads));
        int exit_code = kExitDone;
        with_threads(options->settings.device.threads, [&] {
            catch_interrupts();
            exit_code =
                is_mesh_file(options->input) ? render_mesh(*options, start) : render_file(*options, start);
        });
        return exit_code;
    };
}

} // namespace relief::cli
