// Plain triangle meshes: the CPU engine's tree against Embree's, in one process, on one thread, in turn.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/measure.h"
#include "bench/paper1.h"
#include "bench/triangle_meshes.h"

namespace relief::bench {

struct TrianglesOptions {
    int runs = 7;                     ///< that count, after one that does not; >= 1
    int width = 640, height = 480;    ///< primary rays; each that hits sends one diffuse ray
    Isa isa = Isa::best;              ///< of the CPU engine
    double detail = 1;                ///< of the two meshes that are always measured
    std::vector<TriangleMesh> meshes; ///< measured besides
};

TrianglesOptions make_quick_options(TrianglesOptions options);

/// Builds both trees, compares all hits, then times. Throws Error as TriangleProbe does.
nlohmann::ordered_json run_triangles(const TrianglesOptions& options, const Report& report);

/// triangles.json and triangles.csv.
std::vector<ReportFile> make_triangles_files(const nlohmann::ordered_json& result);

} // namespace relief::bench
