// The measurements of Harada 2015, Rendering Vector Displacement Mapped Surfaces in a GPU Ray Tracer: Table
// 1.1, Figures 1.7, 1.9 and 1.10, on sample scenes that stand in for the paper's.
#pragma once

#include <string>
#include <vector>

#include "bench/measure.h"
#include "common/report.h"
#include "relief/render.h"

namespace relief::bench {

/// Scenes of the paper, in its order.
inline const std::vector<std::string> kPaper1Scenes = {"party", "bark", "barks", "pumpkin"};

struct Paper1Options {
    RenderSettings
        settings; ///< engine, device, size, level ...; the suite sets spp, bounces, surface and cache
    int runs = 5; ///< measured runs after a warm-up, >= 1
    std::vector<std::string> scenes = kPaper1Scenes;
    /// Pre-tessellated scenes whose construction would need more are left out.
    uint64_t tessellated_limit_bytes = uint64_t(4) << 30;
    int bounces = 5; ///< of Figure 1.10, >= 1
};

/// Options of a smoke test: tiny pictures, one run.
Paper1Options make_quick_options(Paper1Options options);

/// Measures all scenes, the largest first, so that peak memory is meaningful. Throws Error{usage} for a scene
/// that is not in the paper, and what rendering throws, except lack of memory, which is a result.
Value run_paper1(const Paper1Options& options, const Report& report);

} // namespace relief::bench
