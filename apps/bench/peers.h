// Relief beside Embree in one process on one surface: first images from cold, warm rays by kind, bytes.
#pragma once

#include <string>
#include <vector>

#include "bench/embree_scene.h"
#include "bench/measure.h"
#include "common/report.h"
#include "relief/render.h"
#include "relief/scene.h"

namespace relief::bench {

/// Scenes that are measured by default: rock, rocks and rock_close with their rough map and, as *_mild, with
/// 0.3 of it; pumpkin and bark; party, of which only its memory is measured.
std::vector<std::string> peers_scene_names();

struct PeersOptions {
    int width = 1280, height = 720;
    int runs = 5;    ///< that count, after one that does not; >= 1
    int threads = 0; ///< of both programs; 0: all cores
    Isa isa = Isa::best;
    std::vector<std::string> scenes = peers_scene_names();
    std::vector<Scene> files; ///< measured besides
    std::vector<int> levels = {3, 4, 5, 6, kAutoLevel};
    /// Embree's triangles, and Relief's tessellated surface, are left out where they would need more.
    uint64_t tessellated_limit_bytes = uint64_t(2) << 30;
};

/// Options of a run that only shows that everything works: tiny pictures, one run, two scenes, two levels.
PeersOptions make_quick_options(PeersOptions options);

inline constexpr EmbreeWay kEmbreeWays[] = {EmbreeWay::triangles, EmbreeWay::grid, EmbreeWay::subdivision};
const char* way_name(EmbreeWay way);
std::string format_level(int level);

/// Throws Error{usage} for an unknown scene, Error{failed} where the programs do not meet the same surface,
/// and what preparing a scene throws.
Value run_peers(const PeersOptions& options, const Report& report);

} // namespace relief::bench
