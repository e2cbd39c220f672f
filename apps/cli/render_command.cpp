#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "commands.h"
#include "common/exit_codes.h"
#include "common/mesh_reader.h"
#include "common/report.h"
#include "common/values.h"
#include "denoiser_search.h"
#include "edit_stream.h"
#include "inputs.h"
#include "interrupt.h"
#include "output.h"
#include "pixel.h"
#include "relief/error.h"
#include "relief/io.h"
#include "relief/render.h"
#include "relief/session.h"
#include "render_options.h"
#include "render_warnings.h"
#include "statistics_report.h"

namespace relief::cli {

namespace {

double get_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Scene load_input(const RenderOptions& options) {
    if (is_mesh_file(options.input)) return load_mesh_scene(options.input, options.mesh);
    constexpr std::string_view kPictures[] = {".exr", ".png", ".tif", ".tiff", ".hdr", ".jpg", ".jpeg"};
    const std::string extension = get_lower_extension(options.input);
    if (std::find(std::begin(kPictures), std::end(kPictures), extension) != std::end(kPictures))
        throw Error(ErrorKind::usage, {"this is a picture, neither a scene nor a mesh", options.input,
                                       "a map goes with its mesh: relief render MESH --vdm MAP"});
    try {
        return load_scene(options.input, make_mesh_reader());
    } catch (const Error& error) {
        if (extension == ".json" || !error.hint().empty()) throw;
        throw Error(error.kind(),
                    {error.message(), error.where(),
                     "a scene file is JSON; meshes are .obj, .ply, .gltf, .glb and .fbx"},
                    error.further());
    }
}

void write_statistics(const std::filesystem::path& file, const RenderResult& result,
                      const RenderSettings& settings) {
    write_text_file(file, write_json(describe_statistics(result, settings), 2));
}

void print_warnings(std::span<const std::string> warnings, bool is_mesh) {
    for (const std::string& warning : warnings)
        fmt::print(stderr, "relief: warning: {}\n", name_setting(warning, is_mesh));
}

void print_summary(const RenderResult& result, const RenderSettings& settings) {
    const Statistics& s = result.statistics;
    const uint64_t rays = s.camera_rays + s.shadow_rays + s.bounce_rays;
    fmt::print(stderr, "{} patches, {} triangles, {} instances on {} ({}, {} threads)\n", s.patches,
               s.triangles, s.instances, s.engine, s.engine == "cpu" ? s.isa : s.device, s.threads);
    fmt::print(stderr, "{}x{} pixels, {}{} samples, {} rays in {:.2f} s, {:.2f} Mray/s\n",
               settings.image.width, settings.image.height, result.is_complete ? "" : "up to ",
               settings.image.spp, rays, s.render_s, s.render_s > 0 ? 1e-6 * double(rays) / s.render_s : 0);
    fmt::print(stderr, "geometry {} B, structures {} B, maps {} B, patch trees {} B\n", s.geometry_bytes,
               s.structures_bytes, s.displacement_bytes, s.bottom_cache_bytes);
}

int get_exit_code(const RenderResult& result, const Saved& saved) {
    if (saved.is_elsewhere) return int(ErrorKind::failed);
    if (!result.is_complete && get_interrupt() != 0) return kExitSignalBase + get_interrupt();
    return kExitDone;
}

/// Start of the wait for a picture, and the time spent reading.
struct PendingTimes {
    double start, load_s;
};

/// Not after an interrupt, which asks for an end. Whatever happens to it, the picture is there to be written;
/// returns the exit code.
int denoise_picture(const RenderOptions& options, RenderResult& result) {
    const double start = get_seconds();
    const auto is_interrupted = [] { return get_interrupt() != 0; };
    int exit_code = kExitDone;
    try {
        if (!options.denoiser->denoise(result.image, is_interrupted)) {
            fmt::print(stderr, "relief: interrupted; the picture is not denoised\n");
            exit_code = kExitSignalBase + get_interrupt();
        }
    } catch (const std::exception& error) {
        fmt::print(stderr, "relief: error: the picture is not denoised: {}\n", error.what());
        exit_code = int(ErrorKind::failed);
    }
    result.statistics.denoise_s = get_seconds() - start;
    return exit_code;
}

/// `printed_warnings`: how many of the warnings were printed before the render.
int finish_picture(const RenderOptions& options, const RenderSettings& settings,
                   const std::filesystem::path& output, const PendingTimes& waiting, RenderResult& result,
                   size_t printed_warnings) {
    Statistics& statistics = result.statistics;
    if (result.whole_samples == 0) {
        fmt::print(stderr, "relief: interrupted before every pixel had a sample; no picture was written\n");
        if (!options.statistics_file.empty()) write_statistics(options.statistics_file, result, settings);
        return get_exit_code(result, {});
    }
    const int denoised = options.is_denoised ? denoise_picture(options, result) : kExitDone;
    const double write_start = get_seconds();
    add_picture_entries(options.aim, output, result.image);
    const Saved saved = save_with_fallback(result.image, output, get_fallback_folders(), write_image);
    statistics.load_s = waiting.load_s;
    statistics.first_image_s += waiting.load_s; // from the start of the command, as perceived by the user
    statistics.write_s = get_seconds() - write_start;
    statistics.total_s = get_seconds() - waiting.start;
    if (!options.progress.is_quiet)
        print_warnings(
            std::span(statistics.warnings).subspan(std::min(printed_warnings, statistics.warnings.size())),
            true);
    if (options.is_verbose) print_summary(result, settings);
    fmt::print("wrote {}\n", saved.file.string());
    std::fflush(stdout); // the sender of edits waits for it
    if (!options.statistics_file.empty()) write_statistics(options.statistics_file, result, settings);
    if (!result.is_complete) fmt::print(stderr, "relief: interrupted; the picture holds what was done\n");
    const int exit_code = get_exit_code(result, saved);
    return exit_code != kExitDone ? exit_code : denoised;
}

/// What a resumed picture has of its own, beyond what this render was asked for.
void tell_of_earlier_samples(const RenderResult& result, const ImageSettings& image) {
    if (result.statistics.camera_rays == 0)
        fmt::print(stderr, "relief: the picture had {} samples already: --spp {} adds none\n",
                   result.whole_samples, image.spp);
    const std::string& range = result.image.metadata.at("relief:samples"); // "A:B"
    const int most = std::stoi(range.substr(range.find(':') + 1)) - image.first_sample;
    const bool is_uneven = image.noise == 0 && image.time_limit_s == 0 && most > result.whole_samples;
    if (is_uneven)
        fmt::print(stderr,
                   "relief: pixels of the unfinished pass keep the {} samples that they had: --spp {} brings "
                   "all others there\n",
                   most, most);
}

int render_picture(const RenderOptions& options, const RenderSettings& settings, Scene scene,
                   const std::filesystem::path& output, const PendingTimes& waiting) {
    catch_interrupts();
    RenderResult result;
    size_t printed_warnings = 0;
    FilmKeeper keeper(options.checkpoint, output);
    {
        RenderWatcher watcher(options, printed_warnings); // its end prints the last line
        result = render(std::move(scene), settings, &watcher, keeper.checkpoints());
        if (watcher.is_refused()) return kExitWarnings;
    }
    if (!options.checkpoint.resumed.empty() && result.is_complete)
        tell_of_earlier_samples(result, settings.image);
    const int exit_code = finish_picture(options, settings, output, waiting, result, printed_warnings);
    return exit_code == kExitDone && keeper.has_failed() ? int(ErrorKind::failed) : exit_code;
}

Camera turn_to(const RenderOptions& options, const Camera& camera, int turn) {
    return turn_camera(camera, 360.0f * float(turn) / float(options.aim.turntable));
}

/// A picture of a session; `printed_warnings` as for finish_picture.
int show_next(const RenderOptions& options, const RenderSettings& settings, Session& session,
              const std::filesystem::path& output, const PendingTimes& waiting, size_t& printed_warnings) {
    RenderResult result;
    {
        RenderWatcher watcher(options, printed_warnings);
        result = session.render(&watcher);
        if (watcher.is_refused()) return kExitWarnings;
    }
    return finish_picture(options, settings, output, waiting, result, printed_warnings);
}

/// The pictures of a turntable, one after the other, of a scene that stays prepared.
int render_turns(const RenderOptions& options, const RenderSettings& settings, Scene scene,
                 PendingTimes waiting) {
    const std::vector<std::string> files = list_files(scene);
    for (int k = 0; k < options.aim.turntable; ++k) keep_files(files, name_turn(options.output, k));
    const Camera camera = scene.camera;
    size_t printed_warnings = 0;
    Session session(std::move(scene), settings);
    int exit_code = kExitDone;
    for (int k = 0; k < options.aim.turntable && exit_code == kExitDone; ++k) {
        if (k > 0) session.change_view(turn_to(options, camera, k), settings.image);
        exit_code =
            show_next(options, settings, session, name_turn(options.output, k), waiting, printed_warnings);
        waiting = {get_seconds(), 0};
    }
    return exit_code;
}

/// The same of tessellated surfaces, whose triangles are those of one view.
int render_tessellated_turns(const RenderOptions& options, const RenderSettings& settings, const Scene& scene,
                             PendingTimes waiting) {
    const std::vector<std::string> files = list_files(scene);
    for (int k = 0; k < options.aim.turntable; ++k) keep_files(files, name_turn(options.output, k));
    int exit_code = kExitDone;
    for (int k = 0; k < options.aim.turntable && exit_code == kExitDone; ++k) {
        Scene turned = scene;
        turned.camera = turn_to(options, scene.camera, k);
        exit_code =
            render_picture(options, settings, std::move(turned), name_turn(options.output, k), waiting);
        waiting = {get_seconds(), 0};
    }
    return exit_code;
}

/// The scene as it is rendered, for --save-scene.
void save_aimed_scene(const RenderOptions& options, const RenderSettings& settings, Scene scene) {
    const ImageSettings& image = settings.image;
    scene.picture = {image.width, image.height, image.spp, image.bounces, image.seed};
    save_scene_copy(scene, options.input, options.mesh, options.aim.saved_scene,
                    list_picture_options(options.aim));
    fmt::print("wrote {}\n", options.aim.saved_scene.string());
}

void print_edit(const EditReport& report) {
    fmt::print(stderr, "edit: {} patches in {:.4f} s\n", report.patches, report.seconds);
}

/// Checks all lines of a file before the first render. Texels are read again when needed, because all of them
/// together may exceed memory.
void check_edits(const std::string& path, const std::string& only_displacement, const Session& session,
                 const std::vector<std::string>& files) {
    std::ifstream file(path);
    EditStream edits(file, path, only_displacement);
    std::set<std::filesystem::path> read, written; // sets: there may be thousands
    while (const std::optional<EditLine> line = edits.next())
        edits.with_place([&] {
            session.check(line->edit);
            const std::filesystem::path texels = find_place(line->edit.texels.file);
            read.insert(texels);
            if (written.contains(texels)) refuse_output(line->edit.texels.file);
            if (line->output.empty()) return;
            keep_files(files, line->output);
            const std::filesystem::path output = find_place(line->output);
            written.insert(output);
            if (read.contains(output)) refuse_output(line->output);
        });
}

/// The first picture, then one after each edit with an output.
int render_edits(const RenderOptions& options, const RenderSettings& settings, Scene scene,
                 PendingTimes waiting) {
    std::ifstream file;
    if (options.edits != "-") file.open(options.edits);
    std::vector<std::string> files = list_files(scene);
    files.push_back(options.edits);
    const std::string only_displacement =
        scene.displacements.size() == 1 ? scene.displacements[0].name : std::string();
    EditStream edits(options.edits == "-" ? std::cin : file,
                     options.edits == "-" ? "standard input" : options.edits, only_displacement);
    size_t printed_warnings = 0;
    Session session(std::move(scene), settings);
    if (options.edits != "-") check_edits(options.edits, only_displacement, session, files);
    const auto show = [&](const std::filesystem::path& output) {
        return show_next(options, settings, session, output, waiting, printed_warnings);
    };
    int exit_code = show(options.output);
    bool is_pending = false; // edits not shown in a picture yet
    while (exit_code == kExitDone) {
        await_input();
        if (get_interrupt() != 0) { // it came with the last picture
            fmt::print(stderr, "relief: interrupted while it waited for edits\n");
            return kExitSignalBase + get_interrupt();
        }
        const std::optional<EditLine> line = edits.next();
        poll_interrupts();
        if (!line) break;
        if (!is_pending) waiting.start = get_seconds() - line->read_s, waiting.load_s = 0;
        edits.with_place([&] {
            keep_files({line->edit.texels.file}, line->output);
            keep_files(files, line->output);
            const EditReport report = session.edit(line->edit);
            if (options.is_verbose) print_edit(report);
        });
        is_pending = line->output.empty();
        if (!is_pending) exit_code = show(line->output);
    }
    return exit_code;
}

/// The camera of a mesh alone is made for landscape pictures and its own angle: others frame it anew.
AimOptions choose_aim(const RenderOptions& options, const ImageSettings& image) {
    AimOptions aim = options.aim.scene;
    const bool fits_already = image.width >= image.height && !aim.fov_degrees;
    if (is_mesh_file(options.input) && !aim.from && !aim.view && !fits_already) aim.frame_all = true;
    return aim;
}

int render_input(const RenderOptions& options, double start) {
    catch_interrupts();
    Scene scene = load_input(options);
    add_assumption_warnings(scene);
    if (options.tile && get_lower_extension(options.output) == ".png")
        scene.warnings.emplace_back("a tile as a PNG cannot be merged: name an .exr");
    const double load_s = get_seconds() - start;
    const std::vector<std::string> files = list_files(scene);
    keep_files(files, options.output), keep_files(files, options.statistics_file);
    keep_files(files, options.aim.saved_scene);
    for (const std::string& film : list_films(options.checkpoint, options.output)) keep_files(files, film);
    RenderSettings settings = make_settings(options, scene.picture);
    check_display(options.aim.display, options.output);
    apply_background(options.aim, options.output, settings.image);
    aim_scene(scene, choose_aim(options, settings.image),
              float(settings.image.width) / float(settings.image.height));
    if (!options.aim.saved_scene.empty()) save_aimed_scene(options, settings, scene);
    const PendingTimes waiting{start, load_s};
    if (!options.edits.empty()) return render_edits(options, settings, std::move(scene), waiting);
    if (options.aim.turntable > 0 && settings.surface.mode == SurfaceMode::tessellated)
        return render_tessellated_turns(options, settings, scene, waiting);
    if (options.aim.turntable > 0) return render_turns(options, settings, std::move(scene), waiting);
    if (!options.pixel) return render_picture(options, settings, std::move(scene), options.output, waiting);
    explain_pixel(scene, settings, options.pixel->first, options.pixel->second);
    if (!options.progress.is_quiet) print_warnings(scene.warnings, is_mesh_file(options.input));
    return options.is_strict && !scene.warnings.empty() ? kExitWarnings : kExitDone;
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
        with_io_threads(options->settings.device.threads, [&] { exit_code = render_input(*options, start); });
        return exit_code;
    };
}

} // namespace relief::cli
