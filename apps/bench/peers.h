// Compares Relief with Embree in one process on the same surface: cold first images, warm rays by kind,
// memory.
#pragma once

#include <string>
#include <vector>

#include "bench/embree_scene.h"
#include "bench/measure.h"
#include "common/report.h"
#include "relief/render.h"
#include "relief/scene.h"

namespace relief::bench {

/// Default scenes: rock, rocks and rock_close with their rough map and, as *_mild, with 0.3 of it; pumpkin
/// and bark; party, for memory only.
std::vector<std::string> peers_scene_names();

struct PeersOptions {
    int width = 1280, height = 720;
    int runs = 5;    ///< measured runs after a warm-up, >= 1
    int threads = 0; ///< for both programs; 0: all cores
    Isa isa = Isa::best;
    std::vector<std::string> scenes = peers_scene_names();
    std::vector<Scene> files; ///< user scenes, measured in addition
    std::vector<int> levels = {3, 4, 5, 6, kAutoLevel};
    /// Embree's triangles and Relief's tessellated surface are left out if they need more.
    uint64_t tessellated_limit_bytes = uint64_t(2) << 30;
};

/// Options of a smoke test: tiny pictures, one run, two scenes, two levels.
PeersOptions make_quick_options(PeersOptions options);

inline constexpr EmbreeWay kEmbreeWays[] = {EmbreeWay::triangles, EmbreeWay::grid, EmbreeWay::subdivision};
const char* way_name(EmbreeWay way);
std::string format_level(int level);

/// Throws Error{usage} for an unknown scene, Error{failed} if the programs do not hit the same surface, and
/// what preparing a scene throws.
Value run_peers(const PeersOptions& options, const Report& report);

} // namespace relief::bench
