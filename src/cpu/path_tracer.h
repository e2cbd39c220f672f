// Path tracing of one tile, with next-event estimation at every vertex.
#pragma once

#include <cstdint>

#include "cpu/picture_footprints.h"
#include "cpu/shading/lights.h"
#include "cpu/tracer.h"
#include "film/film.h"
#include "relief/render.h"

namespace relief::cpu {

/// What the tiles of one render have in common.
struct PathTracerScene {
    const Tracer& tracer;
    const LightSet& lights;
    const RenderSettings& settings;
};

/// Samples [first, first + count) of each pixel.
struct SampleRange {
    int first = 0, count = 1;
};

/// What one or more tiles cost; add them up over threads.
struct TileCounters {
    uint64_t camera_rays = 0, shadow_rays = 0, bounce_rays = 0;
    double shade_s = 0, film_s = 0;
};

/// Edge of the tiles that keep packets full, pixels.
inline constexpr int kTileEdge = 16;

/// What tracing a tile tells besides its samples.
struct TileReport {
    TileCounters counters;
    PictureFootprints* footprints = nullptr; ///< get where rays have been; null: nobody asks
};

/// Adds samples to the pixels of `tile` (inside the film's window, any size; kTileEdge squared is best).
/// Sample k of a pixel depends on (seed, pixel, k) only. Several threads may work on different tiles of one
/// film, where none shares a block of the footprints with another.
void trace_tile(const PathTracerScene& scene, Film& film, const Window& tile, SampleRange samples,
                TileReport& report);

} // namespace relief::cpu
