// What comes after the last ray of a picture: denoising, writing, statistics and what is said of it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "relief/session.h"
#include "render_options.h"
#include "render_warnings.h"

namespace relief::cli {

/// Of a steady clock.
double get_seconds();

/// Start of the wait for a picture, and the time spent reading.
struct PendingTimes {
    double start, load_s;
};

/// Subtracts the time that has passed since the wait began, and the time for denoising, from a time limit.
RenderSettings reserve_time(const RenderOptions& options, RenderSettings settings,
                            const PendingTimes& waiting);

/// Writes a picture and what goes with it; returns the exit code. Warnings that were not told yet are
/// printed.
int finish_picture(const RenderOptions& options, const RenderSettings& settings,
                   const std::filesystem::path& output, const PendingTimes& waiting, RenderResult& result,
                   ToldWarnings& told);

using RenderPicture = std::function<RenderResult(RenderObserver* observer)>;

/// Renders and finishes one of several pictures; `step`: which of them it is, for its
/// progress.
int show_next(const RenderOptions& options, const RenderSettings& settings, const RenderPicture& render,
              const std::filesystem::path& output, const PendingTimes& waiting, ToldWarnings& told,
              const std::string& step = {});

} // namespace relief::cli
