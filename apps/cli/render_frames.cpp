#include "render_frames.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "aim_options.h"
#include "common/console.h"
#include "common/exit_codes.h"
#include "common/inputs.h"
#include "common/report.h"
#include "interrupt.h"
#include "picture_series.h"
#include "relief/error.h"
#include "relief/io.h"
#include "relief/version.h"

namespace relief::cli {

namespace {

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
    check_frame_names(options.output, frames);
    std::set<std::filesystem::path> read;
    for (const int frame : frames)
        for (const std::filesystem::path& file : shot.list_files(frame)) read.insert(find_place(file));
    for (const int frame : frames)
        if (const std::filesystem::path output = name_frame(options.output, frame);
            read.contains(find_place(output)))
            refuse_output(output);
}

/// The frames of one command, one after another.
class FrameLoop {
  public:
    FrameLoop(const RenderOptions& options, const FrameSource& source)
        : options_(options), source_(source), series_(options, &source.shot) {}

    /// `step`: which of them it is; returns the exit code.
    int render(int frame, const std::string& step, PendingTimes waiting) {
        const Shot::View view = prepare(frame);
        if (has_loaded_) waiting.load_s = get_seconds() - waiting.start;
        const std::filesystem::path output = name_frame(options_.output, frame);
        if (!options_.skips_existing || !is_there(options_, series_.settings(), output, view.scene_hash))
            return series_.show(view, frame, output, step, waiting);
        if (has_loaded_) series_.let_go(); // the next frame cannot be told by how it differs from this one
        print_output("kept {}\n", output.string());
        poll_interrupts();
        return get_interrupt() != 0 ? kExitSignalBase + get_interrupt() : int(kExitDone);
    }

  private:
    Shot::View prepare(int frame) {
        has_loaded_ = false;
        // Cameras that options aim need their scenes.
        const bool may_keep = options_.aim.scene == AimOptions{} && series_.can_keep_scene();
        if (may_keep)
            if (const std::optional<Shot::View> view = source_.shot.find_view(frame)) return *view;
        has_loaded_ = true;
        if (may_keep && series_.settings().surface.mode == SurfaceMode::direct) return update(frame);
        series_.let_go();
        auto [scene, settings] = source_.load(frame);
        keep_files(list_files(scene), name_frame(options_.output, frame));
        const Shot::View view{scene.camera, scene.hash};
        series_.hold(std::move(scene), settings);
        return view;
    }

    Shot::View update(int frame) {
        SceneUpdate update = source_.shot.update(frame);
        const Shot::View view{update.camera, update.scene_hash};
        RenderSettings settings = series_.settings();
        if (update.scene) {
            settings = source_.check(*update.scene);
            keep_files(list_files(*update.scene), name_frame(options_.output, frame));
        }
        series_.hold(std::move(update), settings);
        return view;
    }

    const RenderOptions& options_;
    const FrameSource& source_;
    PictureSeries series_;
    bool has_loaded_ = false; ///< more than a camera, for the last frame
};

} // namespace

bool is_frame_pattern(const std::filesystem::path& file) {
    return file.filename().string().find("##") != std::string::npos;
}

void check_frame_names(const std::filesystem::path& pattern, const std::vector<int>& frames) {
    if (frames.size() < 2 || is_frame_pattern(pattern)) return;
    for (const int frame : frames)
        if (name_frame(pattern, frame) == pattern)
            throw Error(
                ErrorKind::usage,
                {fmt::format("this is the name of frame {}, and there are {} frames", frame, frames.size()),
                 pattern.string(),
                 fmt::format("-o {}.####{}", pattern.stem().stem().string(), pattern.extension().string())});
}

int render_frames(const RenderOptions& options, const FrameSource& source, const std::vector<int>& frames,
                  PendingTimes waiting) {
    check_frames_to_come(options, source.shot, frames);
    FrameLoop loop(options, source);
    int exit_code = kExitDone;
    for (size_t k = 0; k < frames.size() && exit_code == kExitDone; ++k) {
        exit_code = loop.render(frames[k], fmt::format("frame {}, {} of {}", frames[k], k + 1, frames.size()),
                                waiting);
        waiting = {get_seconds(), 0};
    }
    return exit_code;
}

} // namespace relief::cli
