// Measures of a Cycles render, parsed from the log of Blender and of our script.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "bench/child_process.h"

namespace relief::bench {

/// Seconds since the call of the render, excluding Blender's start and scene construction.
struct CyclesTimes {
    std::string version;
    double images_s = 0;              ///< reading maps and sky, part of synchronisation
    double synchronisation_s = 0;     ///< until sampling starts: dicing, displacement, trees, lights
    double first_sample_s = 0;        ///< until the log first reports a finished sample
    double render_s = 0;              ///< until the call returned
    uint64_t cycles_peak_bytes = 0;   ///< by Cycles' own count
    uint64_t resident_peak_bytes = 0; ///< of the process, Blender included
};

/// Throws Error{failed}, quoting the end of the log, if something is missing.
CyclesTimes read_cycles_log(std::span<const LogLine> lines);

} // namespace relief::bench
