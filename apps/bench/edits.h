// Time from an edit of a map rectangle to the next picture, against loading the scene again, in one process.
#pragma once

#include <filesystem>
#include <vector>

#include "bench/measure.h"
#include "common/report.h"

namespace relief::bench {

struct EditsOptions {
    std::filesystem::path folder; ///< for the loaded scene; not deleted
    RenderSettings settings;      ///< size, threads and instruction set; the suite sets the rest
    int runs = 5;                 ///< measured fresh loads per configuration, >= 1
    int enlargement = 2;          ///< factor on the sample's map of 2048 x 2048
    uint32_t edge = 256;          ///< side of a rectangle, texels
};

/// Options of a smoke test.
EditsOptions make_quick_options(EditsOptions options);

/// Edits sixteen rectangles spread over the map, one after another. Throws Error{failed} unless the final
/// picture is bit-identical to that of a session started with all edits.
Value run_edits(const EditsOptions& options, const Report& report);

} // namespace relief::bench
