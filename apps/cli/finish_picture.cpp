#include "finish_picture.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "common/console.h"
#include "common/exit_codes.h"
#include "common/report.h"
#include "interrupt.h"
#include "output.h"
#include "relief/error.h"
#include "relief/io.h"
#include "render_warnings.h"
#include "statistics_report.h"
#include "wait_notice.h"

namespace relief::cli {

namespace {

void write_statistics(const std::filesystem::path& file, const RenderResult& result,
                      const RenderSettings& settings) {
    write_text_file(file, write_json(describe_statistics(result, settings), 2));
}

/// "64", "24 of 64" where a time limit ended the render, "16 to 64" where some pixels have more than others.
std::string describe_samples(const RenderResult& result, const RenderSettings& settings) {
    if (result.whole_samples == settings.image.spp) return std::to_string(settings.image.spp);
    const uint64_t pixels = uint64_t(result.image.width) * uint64_t(result.image.height);
    const bool is_even = result.statistics.camera_rays <= pixels * uint64_t(result.whole_samples);
    return fmt::format("{} {} {}", result.whole_samples, is_even ? "of" : "to", settings.image.spp);
}

void print_summary(const RenderResult& result, const RenderSettings& settings) {
    const Statistics& s = result.statistics;
    const uint64_t rays = s.camera_rays + s.shadow_rays + s.bounce_rays;
    print_error("{} patches, {} triangles, {} instances on {} ({}, {} threads)\n", s.patches, s.triangles,
                s.instances, s.engine, s.engine == "cpu" ? s.isa : s.device, s.threads);
    print_error("{}x{} pixels, {} samples, {} rays in {:.2f} s, {:.2f} Mray/s\n", settings.image.width,
                settings.image.height, describe_samples(result, settings), rays, s.render_s,
                s.render_s > 0 ? 1e-6 * double(rays) / s.render_s : 0);
    print_error("read in {:.3f} s, prepared in {:.3f} s{}\n", s.load_s, s.prepare_s,
                s.denoise_s > 0 ? fmt::format(", denoised in {:.3f} s", s.denoise_s) : "");
    print_error("geometry {} B, structures {} B, maps {} B, patch trees {} B\n", s.geometry_bytes,
                s.structures_bytes, s.displacement_bytes, s.bottom_cache_bytes);
}

int get_exit_code(const RenderResult& result, const Saved& saved) {
    if (saved.is_elsewhere) return int(ErrorKind::failed);
    if (!result.is_complete && get_interrupt() != 0) return kExitSignalBase + get_interrupt();
    return kExitDone;
}

/// Shows on the progress of a render that the denoiser works, and at the end for how long it did.
class DenoisingNotice {
  public:
    explicit DenoisingNotice(const ProgressOptions& options)
        : printer_(options), notice_(std::in_place, printer_, "denoising", std::chrono::milliseconds(0)) {}
    void finish(double seconds) {
        notice_.reset();
        Progress progress;
        progress.fraction = -1, progress.elapsed_s = seconds;
        printer_.print(progress, "denoised");
    }

  private:
    ProgressPrinter printer_;
    std::optional<WaitNotice> notice_;
};

/// Prints how many pixels reached the noise asked for, and the noise of the others.
void print_noise(const NoiseReport& noise) {
    const auto asked = float(noise.asked); // as it was written
    if (noise.reached_pixels == noise.pixels)
        return print_error("relief: noise: all {} pixels reached {}\n", noise.pixels, asked);
    const uint64_t others = noise.pixels - noise.reached_pixels;
    print_error(
        "relief: noise: {} of {} pixels ({:.1f} %) reached {}; half of the other {} are below {:.3g}, "
        "the worst are at {:.3g}\n",
        noise.reached_pixels, noise.pixels,
        std::floor(1000.0 * double(noise.reached_pixels) / double(noise.pixels)) / 10, asked, others,
        noise.median, noise.most);
}

/// Prints the reason why the render ended, and how good the picture is.
void print_ends(const RenderOptions& options, const RenderSettings& settings, const RenderResult& result) {
    if (!result.is_complete) print_error("relief: interrupted; the picture holds what was done\n");
    if (options.progress.is_quiet) return;
    if (result.is_out_of_time)
        print_error("relief: the time limit ended the render: each pixel has at least {} of {} samples\n",
                    result.whole_samples, settings.image.spp);
    if (result.is_out_of_time && result.statistics.prepare_s > settings.image.time_limit_s)
        print_error("hint: preparing the scene takes {:.1f} s, which the limit of {:g} s does not shorten\n",
                    result.statistics.prepare_s, settings.image.time_limit_s);
    if (!result.noise) return;
    print_noise(*result.noise);
    if (result.noise->reached_pixels < result.noise->pixels && result.is_complete && !result.is_out_of_time)
        print_error("hint: --spp is the most samples that a pixel gets, {} here: a larger one lets more "
                    "pixels reach it\n",
                    settings.image.spp);
}

/// Not after an interrupt, which asks for an end. Whatever happens to it, the picture is there to be written;
/// returns the exit code.
int denoise_picture(const RenderOptions& options, RenderResult& result) {
    const double start = get_seconds();
    const auto is_interrupted = [] { return get_interrupt() != 0; };
    int exit_code = kExitDone;
    DenoisingNotice notice(options.progress);
    try {
        if (!options.denoiser->denoise(result.image, is_interrupted)) {
            print_error("relief: interrupted; the picture is not denoised\n");
            exit_code = kExitSignalBase + get_interrupt();
        }
    } catch (const std::exception& error) {
        print_error("relief: error: the picture is not denoised: {}\n", error.what());
        exit_code = int(ErrorKind::failed);
    }
    result.statistics.denoise_s = get_seconds() - start;
    if (exit_code == kExitDone) notice.finish(result.statistics.denoise_s);
    return exit_code;
}

} // namespace

double get_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

RenderSettings reserve_time(const RenderOptions& options, RenderSettings settings,
                            const PendingTimes& waiting) {
    ImageSettings& image = settings.image;
    if (image.time_limit_s == 0) return settings;
    const Window crop = image.crop == Window{} ? Window{0, 0, image.width, image.height} : image.crop;
    const size_t pixels = size_t(crop.x1 - crop.x0) * size_t(crop.y1 - crop.y0);
    const double denoising_s = options.is_denoised ? options.denoiser->estimate_seconds(pixels) : 0;
    image.time_reserved_s = get_seconds() - waiting.start + denoising_s;
    return settings;
}

int finish_picture(const RenderOptions& options, const RenderSettings& settings,
                   const std::filesystem::path& output, const PendingTimes& waiting, RenderResult& result,
                   ToldWarnings& told) {
    Statistics& statistics = result.statistics;
    if (result.whole_samples == 0) {
        print_error("relief: interrupted before every pixel had a sample; no picture was written\n");
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
        print_warnings(told.take_new(statistics.warnings), is_mesh_file(options.input));
    if (options.is_verbose) print_summary(result, settings);
    print_output("wrote {}\n", saved.file.string());
    flush_output(); // the sender of edits waits for it
    if (!options.statistics_file.empty()) write_statistics(options.statistics_file, result, settings);
    print_ends(options, settings, result);
    const int exit_code = get_exit_code(result, saved);
    return exit_code != kExitDone ? exit_code : denoised;
}

int show_next(const RenderOptions& options, const RenderSettings& settings, const RenderPicture& render,
              const std::filesystem::path& output, const PendingTimes& waiting, ToldWarnings& told,
              const std::string& step) {
    RenderResult result;
    {
        RenderWatcher watcher(options, told, step);
        result = render(&watcher);
        if (watcher.is_refused()) return kExitWarnings;
    }
    return finish_picture(options, settings, output, waiting, result, told);
}

} // namespace relief::cli
