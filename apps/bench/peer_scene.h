// A scene at one level, as measured.
#pragma once

#include <cstdint>
#include <string>

#include "bench/measure.h"
#include "relief/render.h"
#include "relief/scene.h"

namespace relief::bench {

/// One scene at one level; the settings hold size, level, threads and instruction set.
struct PeerScene {
    const Scene& scene;
    std::string name; ///< with the level
    RenderSettings settings;
    int runs;
    bool has_triangles; ///< of Embree; false if they need too much memory
    const Report& report;
};

} // namespace relief::bench
