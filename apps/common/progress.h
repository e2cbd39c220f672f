// Progress on stderr: a bar for terminals, lines for logs, JSON for programs. One printer for renders, other
// commands and measurements.
#pragma once

#include <chrono>
#include <string>

#include "common/cli_app.h"
#include "relief/progress.h"
#include "relief/render.h"

namespace relief::cli {

enum class ProgressStyle { automatic, bar, plain, json, none };

struct ProgressOptions {
    ProgressStyle style = ProgressStyle::automatic;
    bool is_quiet = false; ///< as style none
};

/// Adds --progress and -q, and returns the latter.
CLI::Option* add_progress_options(CLI::App& verb, ProgressOptions& options, const char* quiet_help);

/// One line without newline: percent, elapsed time, time left, of a render also samples and rays per second.
/// `step` comes first, unless it is empty.
std::string format_progress(const Progress& progress, const std::string& step = {});

/// The same as one JSON object: percent, elapsed_s, left_s, of a render also samples, samples_total, rays,
/// rays_per_second; step, unless it is empty.
std::string format_progress_json(const Progress& progress, const std::string& step = {});

class ProgressPrinter {
  public:
    /// `automatic` is a bar on a terminal and lines otherwise. Lines are some seconds apart; a final one is
    /// printed after others, or if lines were requested explicitly.
    explicit ProgressPrinter(const ProgressOptions& options);
    ~ProgressPrinter();
    ProgressPrinter(const ProgressPrinter&) = delete;
    ProgressPrinter& operator=(const ProgressPrinter&) = delete;

    /// A fraction below 0 is not known. A new step has its line at once.
    void print(const Progress& progress, const std::string& step = {});

    /// Before other output: what follows begins below the bar.
    void end_line();

  private:
    void print_bar(const Progress& progress, const std::string& step);

    ProgressStyle style_;
    std::chrono::steady_clock::time_point last_line_;
    std::string last_step_;
    bool has_bar_ = false;
    bool tells_end_; ///< print the final line
};

/// Prints the progress of what is no render, once it has taken longer than a moment.
class WorkProgress {
  public:
    explicit WorkProgress(const ProgressOptions& options);

    /// For the part [from, to] of the work. Valid as long as this.
    ProgressFunction part(double from, double to);

    void tell(double fraction);
    /// The next step of work whose end is not known.
    void begin_step(const std::string& step);
    void end_line() { printer_.end_line(); }

  private:
    void print(double fraction, const std::string& step);

    ProgressPrinter printer_;
    std::chrono::steady_clock::time_point start_;
};

} // namespace relief::cli
