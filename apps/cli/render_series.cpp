#include "render_series.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "aim_options.h"
#include "common/exit_codes.h"
#include "common/inputs.h"
#include "common/report.h"
#include "edit_stream.h"
#include "interrupt.h"
#include "relief/aim.h"
#include "relief/error.h"
#include "relief/io.h"
#include "relief/version.h"
#include "render_warnings.h"

namespace relief::cli {

namespace {

/// Pictures of a scene that stays prepared while nothing but its camera changes.
class Series {
  public:
    explicit Series(const RenderOptions& options) : options_(options) {}

    /// The scene of the pictures to come. Warnings that an earlier one had are not told again.
    void hold(Scene scene, const RenderSettings& settings) {
        const auto is_told = [&](const std::string& warning) { return !told_.insert(warning).second; };
        if (!options_.is_strict) std::erase_if(scene.warnings, is_told);
        scene_ = std::move(scene), settings_ = settings, printed_warnings_ = 0;
    }
    /// Frees what the last scene takes.
    void let_go() { session_.reset(), scene_.reset(); }
    /// Far from the origin, pictures depend a little on the camera of the session's first one.
    bool can_keep_scene() const { return scene_ || (session_ && !session_->is_far_away()); }
    const RenderSettings& settings() const { return settings_; }

    /// Renders and writes one, whose progress begins with `step`; returns the exit code.
    int show(const Shot::View& view, const std::filesystem::path& output, const std::string& step,
             const PendingTimes& waiting) {
        if (settings_.surface.mode == SurfaceMode::tessellated)
            return show_alone(view, output, step, waiting);
        if (scene_) {
            scene_->camera = view.camera, scene_->hash = view.scene_hash;
            session_.emplace(std::move(*scene_), settings_, SessionUse::views);
            scene_.reset();
        } else {
            session_->change_view(view.camera, settings_.image, view.scene_hash);
        }
        return show_next(options_, settings_, *session_, output, waiting, printed_warnings_, step);
    }

  private:
    /// Tessellated surfaces are made for one view.
    int show_alone(const Shot::View& view, const std::filesystem::path& output, const std::string& step,
                   const PendingTimes& waiting) {
        Scene scene = *scene_;
        scene.camera = view.camera, scene.hash = view.scene_hash;
        RenderResult result;
        {
            RenderWatcher watcher(options_, printed_warnings_, step);
            result = render(std::move(scene), settings_, &watcher);
            if (watcher.is_refused()) return kExitWarnings;
        }
        return finish_picture(options_, settings_, output, waiting, result, printed_warnings_);
    }

    const RenderOptions& options_;
    RenderSettings settings_;
    std::optional<Scene> scene_; ///< not prepared yet, or tessellated
    std::optional<Session> session_;
    size_t printed_warnings_ = 0; ///< of the scene
    std::set<std::string> told_;
};

Camera turn_to(const RenderOptions& options, const Camera& camera, int turn) {
    return turn_camera(camera, 360.0f * float(turn) / float(options.aim.turntable));
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

bool has_layer(const Image& image, const std::string& layer) {
    return std::ranges::any_of(image.channels,
                               [&](const std::string& channel) { return channel.starts_with(layer); });
}

/// Entries of the header that decide what a picture shows.
std::map<std::string, std::string> list_entries(const RenderOptions& options, const RenderSettings& settings,
                                                const std::filesystem::path& output, uint64_t scene_hash) {
    const ImageSettings& s = settings.image;
    Image image;
    add_picture_entries(options.aim, output, image);
    std::map<std::string, std::string> entries = std::move(image.metadata);
    entries["relief:scene_hash"] = fmt::format("{:016x}", scene_hash);
    entries["relief:settings"] = describe_settings(settings);
    entries["relief:samples"] = fmt::format("{}:{}", s.first_sample, s.first_sample + s.spp);
    entries["relief:seed"] = std::to_string(s.seed);
    entries["relief:version"] = RELIEF_VERSION_STRING;
    if (s.noise > 0) entries["relief:noise"] = fmt::format("{}", s.noise);
    if (const Window& w = s.whole_window; w != Window{})
        entries["relief:whole_window"] = fmt::format("{},{},{},{}", w.x0, w.y0, w.x1, w.y1);
    return entries;
}

/// Whether a file holds what a render would write to it.
bool is_there(const RenderOptions& options, const RenderSettings& settings,
              const std::filesystem::path& output, uint64_t scene_hash) {
    std::error_code code;
    if (!std::filesystem::is_regular_file(output, code)) return false;
    Image image;
    try {
        image = read_image(output);
    } catch (const Error&) {
        return false; // damaged: rendered again
    }
    const auto entries = list_entries(options, settings, output, scene_hash);
    for (const auto& [key, value] : entries)
        if (const auto found = image.metadata.find(key);
            found == image.metadata.end() || found->second != value)
            return false;
    for (const char* key : {"relief:interrupted", "relief:time_limit", "relief:noise", "relief:whole_window",
                            "relief:background", "relief:exposure"})
        if (image.metadata.contains(key) && !entries.contains(key)) return false;
    const ImageSettings& s = settings.image;
    const Window crop = s.crop == Window{} ? Window{0, 0, s.width, s.height} : s.crop;
    return s.time_limit_s == 0 && image.full_width == s.width && image.full_height == s.height &&
           Window{image.x0, image.y0, image.x0 + image.width, image.y0 + image.height} == crop &&
           has_layer(image, "noisy.") == options.is_denoised &&
           std::ranges::all_of(s.layers, [&](const std::string& layer) { return has_layer(image, layer); });
}

/// Refuses pictures in place of files that any frame reads, and frames whose files are not there.
void check_frames_to_come(const RenderOptions& options, const Shot& shot, const std::vector<int>& frames) {
    std::set<std::filesystem::path> read;
    for (const int frame : frames)
        for (const std::filesystem::path& file : shot.list_files(frame)) read.insert(find_place(file));
    for (const int frame : frames)
        if (const std::filesystem::path output = name_frame(options.output, frame);
            read.contains(find_place(output)))
            refuse_output(output);
}

} // namespace

int render_turns(const RenderOptions& options, const RenderSettings& settings, Scene scene,
                 PendingTimes waiting) {
    const std::vector<std::string> files = list_files(scene);
    for (int k = 0; k < options.aim.turntable; ++k) keep_files(files, name_turn(options.output, k));
    const Camera camera = scene.camera;
    const uint64_t hash = scene.hash;
    Series series(options);
    series.hold(std::move(scene), settings);
    int exit_code = kExitDone;
    for (int k = 0; k < options.aim.turntable && exit_code == kExitDone; ++k) {
        exit_code =
            series.show({turn_to(options, camera, k), k == 0 ? hash : 0}, name_turn(options.output, k),
                        fmt::format("picture {} of {}", k + 1, options.aim.turntable), waiting);
        waiting = {get_seconds(), 0};
    }
    return exit_code;
}

int render_frames(const RenderOptions& options, Shot& shot, const std::vector<int>& frames,
                  const LoadFrame& load, PendingTimes waiting) {
    check_frames_to_come(options, shot, frames);
    Series series(options);
    const bool may_keep = options.aim.scene == AimOptions{}; // its cameras need their scenes
    size_t count = 0;
    for (const int frame : frames) {
        ++count;
        std::optional<Shot::View> view;
        if (may_keep && series.can_keep_scene()) view = shot.find_view(frame);
        if (!view) {
            series.let_go();
            auto [scene, settings] = load(frame);
            view = Shot::View{scene.camera, scene.hash};
            keep_files(list_files(scene), name_frame(options.output, frame));
            series.hold(std::move(scene), settings);
            waiting.load_s = get_seconds() - waiting.start;
        }
        const std::filesystem::path output = name_frame(options.output, frame);
        int exit_code = kExitDone;
        if (options.skips_existing && is_there(options, series.settings(), output, view->scene_hash)) {
            fmt::print("kept {}\n", output.string());
            poll_interrupts();
            if (get_interrupt() != 0) exit_code = kExitSignalBase + get_interrupt();
        } else {
            const std::string step = fmt::format("frame {}, {} of {}", frame, count, frames.size());
            exit_code = series.show(*view, output, step, waiting);
        }
        if (exit_code != kExitDone) return exit_code;
        waiting = {get_seconds(), 0};
    }
    return kExitDone;
}

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

} // namespace relief::cli
