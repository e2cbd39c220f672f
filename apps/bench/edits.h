// A painted rectangle of a map until the next picture, beside the same scene loaded afresh, in one process.
#pragma once

#include <filesystem>
#include <vector>

#include "bench/measure.h"
#include "common/report.h"

namespace relief::bench {

struct EditsOptions {
    std::filesystem::path folder; ///< for the scene that is loaded; left behind
    RenderSettings settings;      ///< size, threads and instruction set; all else is the suite's
    int runs = 5;                 ///< fresh loads that count, of each kind of picture; >= 1
    int enlargement = 2;          ///< of the sample's map, which is 2048 x 2048
    uint32_t edge = 256;          ///< of a rectangle, texels
};

/// Options of a run that only shows that everything works.
EditsOptions make_quick_options(EditsOptions options);

/// Sixteen rectangles spread over the map, each painted over in turn. Throws Error{failed} where the picture
/// after all of them is not, bit for bit, that of a session which began with them.
Value run_edits(const EditsOptions& options, const Report& report);

} // namespace relief::bench
