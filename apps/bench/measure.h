// Repeated, interleaved frame measurements: medians with their spread.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/report.h"
#include "relief/render.h"
#include "relief/scene.h"

namespace relief::bench {

/// Called with one line about the next step.
using Report = std::function<void(const std::string&)>;

/// One variant of rendering a scene, with the statistics of its runs.
struct Variant {
    std::string name;
    RenderSettings settings;
    std::vector<Statistics> runs; ///< without the warm-up run
    std::string refusal;          ///< not empty: why the engine rejected it
};

/// {median, lowest, highest, runs}; for an even count the mean of the middle two. `values` is not empty.
Value summarize(std::vector<double> values);

/// {median, lower_quartile, upper_quartile, lowest, highest, runs}; quartiles are interpolated linearly
/// between the sorted values. `values` is not empty.
Value summarize_quartiles(std::vector<double> values);

/// Seconds of one run.
using Measure = std::function<double()>;

/// Runs all interleaved, once for warm-up, then `runs` times; returns the seconds of every measured run of
/// each.
std::vector<std::vector<double>> time_in_turn(const std::vector<Measure>& measures, int runs);

/// Renders all variants once for warm-up, then `runs` times interleaved (a, b, c, a, b, c ...), so that
/// changes of the machine's speed affect all. A variant rejected for lack of memory records the reason.
void measure_in_turn(const Scene& scene, int runs, std::vector<Variant>& variants, const Report& report);

/// White materials, so that paths end when they leave the scene, not by Russian roulette.
Scene make_white(Scene scene);

/// Median seconds by stage, frame and preparation with their spread, bytes.
Value describe_frames(const std::vector<Statistics>& runs);

/// Median seconds of each cast: {depth, kind, rays, pairs, seconds by stage, total_s with spread}.
Value describe_casts(const std::vector<Statistics>& runs);

} // namespace relief::bench
