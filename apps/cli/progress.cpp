#include "progress.h"

#include <cstdio>
#include <unistd.h>

#include <fmt/format.h>

#include "common/report.h"
#include "interrupt.h"

namespace relief::cli {

namespace {

constexpr std::chrono::seconds kPlainInterval{2};
constexpr int kBarWidth = 24;

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

} // namespace

std::string format_progress(const Progress& progress) {
    const double left = compute_left(progress);
    return fmt::format("{:3.0f} %  {}/{} samples  {:.2f} Mray/s  {} elapsed  {} left",
                       100 * progress.fraction, progress.samples_done, progress.samples_total,
                       compute_rays_per_second(progress) * 1e-6, format_time(progress.elapsed_s),
                       left < 0 ? "?" : format_time(left));
}

std::string format_progress_json(const Progress& progress) {
    Value line = {{"percent", 100 * progress.fraction},
                  {"samples", progress.samples_done},
                  {"samples_total", progress.samples_total},
                  {"rays", progress.rays},
                  {"rays_per_second", compute_rays_per_second(progress)},
                  {"elapsed_s", progress.elapsed_s}};
    const double left = compute_left(progress);
    line["left_s"] = left < 0 ? Value() : Value(left);
    return write_json(line);
}

ProgressPrinter::ProgressPrinter(ProgressStyle style)
    : style_(style), last_line_(std::chrono::steady_clock::now()), tells_end_(style == ProgressStyle::plain) {
    if (style_ == ProgressStyle::automatic)
        style_ = isatty(STDERR_FILENO) ? ProgressStyle::bar : ProgressStyle::plain;
}

ProgressPrinter::~ProgressPrinter() {
    if (has_bar_) fmt::print(stderr, "\n");
}

void ProgressPrinter::on_progress(const Progress& progress) {
    if (style_ == ProgressStyle::none) return;
    if (style_ == ProgressStyle::bar) return print_bar(progress);
    if (style_ == ProgressStyle::json) {
        fmt::print(stderr, "{}\n", format_progress_json(progress));
        return;
    }
    const auto now = std::chrono::steady_clock::now();
    const bool is_last = progress.samples_done == progress.samples_total;
    if (now - last_line_ < kPlainInterval && !(is_last && tells_end_)) return;
    last_line_ = now, tells_end_ = true;
    fmt::print(stderr, "{}\n", format_progress(progress));
}

void ProgressPrinter::print_bar(const Progress& progress) {
    const int filled = int(progress.fraction * kBarWidth);
    // "\x1b[K" clears the rest of a longer previous line.
    fmt::print(stderr, "\r[{:<{}}] {}\x1b[K", std::string(size_t(filled), '#'), kBarWidth,
               format_progress(progress));
    std::fflush(stderr);
    has_bar_ = true;
}

bool ProgressPrinter::is_cancelled() const { return get_interrupt() != 0; }

} // namespace relief::cli
