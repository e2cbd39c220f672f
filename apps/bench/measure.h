// Frames measured many times in turn: medians with their spread.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/report.h"
#include "relief/render.h"
#include "relief/scene.h"

namespace relief::bench {

/// Called with one line about what comes next.
using Report = std::function<void(const std::string&)>;

/// One way to render a scene, and what its runs said.
struct Variant {
    std::string name;
    RenderSettings settings;
    std::vector<Statistics> runs; ///< without the first, which warms up
    std::string refusal;          ///< not empty: the engine refused it, for this reason
};

/// {median, lowest, highest, runs}; of an even count the mean of the middle two. `values` is not empty.
Value summarize(std::vector<double> values);

/// What one run of something took, seconds.
using Measure = std::function<double()>;

/// All in turn, first once to warm up, then `runs` times; seconds of every run that counts, of each.
std::vector<std::vector<double>> time_in_turn(const std::vector<Measure>& measures, int runs);

/// Renders all variants once to warm up, then `runs` times in turn (a, b, c, a, b, c ...), so that a machine
/// that changes its speed changes it for all. A variant that is refused for want of memory keeps the reason.
void measure_in_turn(const Scene& scene, int runs, std::vector<Variant>& variants, const Report& report);

/// White, so that paths end where they leave the scene, not where they have grown dim.
Scene make_white(Scene scene);

/// Median seconds by stage, frame and preparation with their spread, bytes.
Value describe_frames(const std::vector<Statistics>& runs);

/// Median seconds of each cast: {depth, kind, rays, pairs, seconds by stage, total_s with spread}.
Value describe_casts(const std::vector<Statistics>& runs);

} // namespace relief::bench
