// What comes after the last ray of a picture: denoising, writing, statistics and what is said of it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "relief/session.h"
#include "render_options.h"

namespace relief::cli {

/// Of a steady clock.
double get_seconds();

/// Start of the wait for a picture, and the time spent reading.
struct PendingTimes {
    double start, load_s;
};

/// `is_mesh`: settings are named as options.
void print_warnings(std::span<const std::string> warnings, bool is_mesh);

/// Writes a picture and what goes with it; returns the exit code. `printed_warnings`: how many of the
/// warnings were printed before the render.
int finish_picture(const RenderOptions& options, const RenderSettings& settings,
                   const std::filesystem::path& output, const PendingTimes& waiting, RenderResult& result,
                   size_t printed_warnings);

using RenderPicture = std::function<RenderResult(RenderObserver* observer)>;

/// Renders and finishes one of several pictures; `printed_warnings` counts on. `step`: which of them it is,
/// for its progress.
int show_next(const RenderOptions& options, const RenderSettings& settings, const RenderPicture& render,
              const std::filesystem::path& output, const PendingTimes& waiting, size_t& printed_warnings,
              const std::string& step = {});

} // namespace relief::cli
