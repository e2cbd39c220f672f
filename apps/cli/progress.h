// Progress of a render on stderr: a bar for terminals, lines for logs, JSON for programs.
#pragma once

#include <chrono>
#include <string>

#include "relief/render.h"

namespace relief::cli {

enum class ProgressStyle { automatic, bar, plain, json, none };

/// One line without newline: percent, samples, rays per second, elapsed time, time left.
std::string format_progress(const Progress& progress);

/// The same as one JSON object: percent, samples, samples_total, rays, rays_per_second, elapsed_s, left_s.
std::string format_progress_json(const Progress& progress);

/// Prints progress and cancels the render on Ctrl-C.
class ProgressPrinter : public RenderObserver {
  public:
    /// `automatic` is a bar on a terminal and lines otherwise. Lines are some seconds apart; a final one is
    /// printed after others, or if lines were requested explicitly.
    explicit ProgressPrinter(ProgressStyle style);
    ~ProgressPrinter() override;
    ProgressPrinter(const ProgressPrinter&) = delete;
    ProgressPrinter& operator=(const ProgressPrinter&) = delete;

    void on_progress(const Progress& progress) override;
    bool is_cancelled() const override;

  private:
    void print_bar(const Progress& progress);

    ProgressStyle style_;
    std::chrono::steady_clock::time_point last_line_;
    bool has_bar_ = false;
    bool tells_end_; ///< print the final line
};

} // namespace relief::cli
