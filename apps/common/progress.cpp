#include "common/progress.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>
#include <unistd.h>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/console.h"
#include "common/report.h"
#include "common/values.h"

namespace relief::cli {

namespace {

constexpr std::chrono::seconds kPlainInterval{2};
constexpr int kBarWidth = 24;
constexpr double kMoment = 0.5; ///< seconds that need no bar, unless of a render

std::string format_time(double seconds) {
    const long whole = long(seconds + 0.5);
    if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

double compute_rays_per_second(const Progress& progress) {
    return progress.elapsed_s > 0 ? double(progress.rays) / progress.elapsed_s : 0;
}

/// Estimated seconds left; negative if unknown.
double compute_left(const Progress& progress) {
    return progress.fraction > 0 ? progress.elapsed_s * (1 - progress.fraction) / progress.fraction : -1;
}

bool is_render(const Progress& progress) { return progress.samples_total > 0; }

bool is_end(const Progress& progress) {
    return is_render(progress) ? progress.samples_done == progress.samples_total : progress.fraction >= 1;
}

} // namespace

CLI::Option* add_progress_options(CLI::App& verb, ProgressOptions& options, const char* quiet_help) {
    verb.add_option_function<std::string>(
            "--progress",
            [&options](const std::string& text) {
                constexpr std::array<std::pair<std::string_view, ProgressStyle>, 5> words{
                    {{"auto", ProgressStyle::automatic},
                     {"bar", ProgressStyle::bar},
                     {"plain", ProgressStyle::plain},
                     {"json", ProgressStyle::json},
                     {"none", ProgressStyle::none}}};
                options.style = parse_word("--progress", text, words);
            },
            "auto (default), bar, plain, json, none")
        ->type_name("NAME");
    return verb.add_flag("-q", options.is_quiet, quiet_help);
}

std::string format_progress(const Progress& progress, const std::string& step) {
    const double left = compute_left(progress);
    const std::string rays =
        is_render(progress) ? fmt::format("  {}/{} samples  {:.2f} Mray/s", progress.samples_done,
                                          progress.samples_total, compute_rays_per_second(progress) * 1e-6)
                            : std::string();
    if (progress.fraction < 0) return fmt::format("{}  {} elapsed", step, format_time(progress.elapsed_s));
    return fmt::format("{}{:3.0f} %{}  {} elapsed  {} left", step.empty() ? "" : step + "  ",
                       100 * progress.fraction, rays, format_time(progress.elapsed_s),
                       left < 0 ? "?" : format_time(left));
}

std::string format_progress_json(const Progress& progress, const std::string& step) {
    Value line = {{"percent", progress.fraction < 0 ? Value() : Value(100 * progress.fraction)},
                  {"elapsed_s", progress.elapsed_s}};
    if (is_render(progress)) {
        line["samples"] = progress.samples_done;
        line["samples_total"] = progress.samples_total;
        line["rays"] = progress.rays;
        line["rays_per_second"] = compute_rays_per_second(progress);
    }
    if (!step.empty()) line["step"] = step;
    const double left = compute_left(progress);
    line["left_s"] = left < 0 ? Value() : Value(left);
    return write_json(line);
}

ProgressPrinter::ProgressPrinter(const ProgressOptions& options)
    : style_(options.is_quiet ? ProgressStyle::none : options.style),
      last_line_(std::chrono::steady_clock::now()),
      tells_end_(style_ == ProgressStyle::plain) {
    if (style_ == ProgressStyle::automatic)
        style_ = isatty(STDERR_FILENO) ? ProgressStyle::bar : ProgressStyle::plain;
}

ProgressPrinter::~ProgressPrinter() { end_line(); }

void ProgressPrinter::end_line() {
    if (has_bar_) write_error("\n");
    has_bar_ = false;
}

void ProgressPrinter::print(const Progress& progress, const std::string& step) {
    if (style_ == ProgressStyle::none) return;
    if (style_ == ProgressStyle::bar) {
        if (has_bar_ || is_render(progress) || progress.elapsed_s >= kMoment) print_bar(progress, step);
        return;
    }
    if (style_ == ProgressStyle::json) {
        write_error(format_progress_json(progress, step) + "\n");
        return;
    }
    const auto now = std::chrono::steady_clock::now();
    if (now - last_line_ < kPlainInterval && step == last_step_ && !(is_end(progress) && tells_end_)) return;
    last_line_ = now, last_step_ = step, tells_end_ = true;
    write_error(format_progress(progress, step) + "\n");
}

void ProgressPrinter::print_bar(const Progress& progress, const std::string& step) {
    const int filled = std::max(0, int(progress.fraction * kBarWidth));
    // "\x1b[K" clears the rest of a longer previous line.
    write_error(fmt::format("\r[{:<{}}] {}\x1b[K", std::string(size_t(filled), '#'), kBarWidth,
                            format_progress(progress, step)));
    std::fflush(stderr);
    has_bar_ = true;
}

WorkProgress::WorkProgress(const ProgressOptions& options)
    : printer_(options), start_(std::chrono::steady_clock::now()) {}

ProgressFunction WorkProgress::part(double from, double to) {
    return [this, from, to](double fraction) { tell(from + fraction * (to - from)); };
}

void WorkProgress::tell(double fraction) { print(fraction, {}); }

void WorkProgress::begin_step(const std::string& step) { print(-1, step); }

void WorkProgress::print(double fraction, const std::string& step) {
    Progress progress;
    progress.fraction = fraction;
    progress.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    printer_.print(progress, step);
    if (fraction >= 1) printer_.end_line(); // what is said of the result comes below
}

} // namespace relief::cli
