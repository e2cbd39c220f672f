// The measurements of Harada 2015, Rendering Vector Displacement Mapped Surfaces in a GPU Ray Tracer: Table
// 1.1, Figures 1.7, 1.9 and 1.10, on sample scenes that stand in for the paper's.
#pragma once

#include <string>
#include <vector>

#include "bench/measure.h"
#include "common/report.h"
#include "relief/render.h"

namespace relief::bench {

/// Scenes that the paper names, in its order.
inline const std::vector<std::string> kPaper1Scenes = {"party", "bark", "barks", "pumpkin"};

struct Paper1Options {
    RenderSettings
        settings; ///< engine, device, size, level ...; spp, bounces, surface and cache are the suite's
    int runs = 5; ///< that count, after one that does not; >= 1
    std::vector<std::string> scenes = kPaper1Scenes;
    /// Pre-tessellated scenes that would need more while they are made are left out.
    uint64_t tessellated_limit_bytes = uint64_t(4) << 30;
    int bounces = 5; ///< of Figure 1.10, >= 1
};

/// Options of a run that only shows that everything works: tiny pictures, one run.
Paper1Options make_quick_options(Paper1Options options);

/// Measures all, in the order that keeps the peak of memory honest: the largest scene first. Throws
/// Error{usage} for a scene that is none of the paper's, and what rendering throws, apart from what is
/// refused for want of memory: that is a result.
Value run_paper1(const Paper1Options& options, const Report& report);

} // namespace relief::bench
