#include "bench/peers_goals.h"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace relief::bench {

namespace {

constexpr double kPeersBytesAPatch = 64, kBytesAMicroQuad = 14, kPeersPartyMebibytes = 448;
constexpr double kColdPrimary = 12, kColdPrimaryTriangles = 60, kColdSecond = 3, kColdSecondTriangles = 10;
constexpr double kPinhole = 5, kCoherent = 2, kIncoherent = 1.7, kIncoherentGrid = 2.3;
constexpr double kPeersDepthRatio = 1.3, kTwoThreads = 1.9, kAvx2 = 0.7;

/// Ratio of a goal of 0 that was reached.
constexpr double kReachedFully = 1;

std::optional<double> get_median(const Value& parts, const char* part) {
    if (!parts.contains(part)) return std::nullopt;
    return parts[part]["median"].get<double>();
}

/// Key of a way of a cast; an empty label or 0 threads match any.
struct WayKey {
    std::string_view program, way, call, isa;
    int threads;
};

std::optional<double> find_seconds(const Value& cast, const WayKey& key) {
    for (const Value& way : cast["ways"]) {
        const auto fits = [&](const char* label, std::string_view wanted) {
            return wanted.empty() || way.text_or_empty(label) == wanted;
        };
        if (fits("program", key.program) && fits("way", key.way) && fits("call", key.call) &&
            fits("isa", key.isa) && (key.threads == 0 || way["threads"] == key.threads))
            return way["seconds"]["median"].get<double>();
    }
    return std::nullopt;
}

class GoalList {
  public:
    void set_place(const Value& scene) {
        scene_ = scene["scene"].get<std::string>(), level_ = scene["level"].get<std::string>();
    }

    void add_most(const std::string& name, double goal, std::optional<double> reached, const char* unit) {
        if (reached)
            add(name, goal, *reached, "at most", *reached > 0 ? goal / *reached : kReachedFully, unit);
    }
    /// Quotient of two measures, if both exist.
    void add_least(const std::string& name, double goal, std::optional<double> dividend,
                   std::optional<double> divisor) {
        if (!dividend || !divisor || *divisor <= 0) return;
        const double reached = *dividend / *divisor;
        add(name, goal, reached, "at least", reached / goal, "times");
    }

    Value take() { return std::move(goals_); }

  private:
    void add(const std::string& name, double goal, double reached, const char* bound, double ratio,
             const char* unit) {
        goals_.push_back(
            {{"name", scene_.empty() ? name : fmt::format("{}, level {}: {}", scene_, level_, name)},
             {"what", name},
             {"scene", scene_},
             {"level", level_},
             {"goal", goal},
             {"bound", bound},
             {"reached", reached},
             {"ratio", ratio},
             {"unit", unit},
             {"met", ratio >= 1}});
    }

    Value goals_ = Value::list();
    std::string scene_, level_;
};

std::optional<double> find_best(const Value& cold, const char* part) {
    std::optional<double> best;
    for (const char* way : {"triangles", "grid", "subdivision"})
        if (cold.contains(way))
            if (const auto seconds = get_median(cold[way], part))
                best = std::min(best.value_or(*seconds), *seconds);
    return best;
}

void add_cold_goals(const Value& cold, GoalList& goals) {
    struct Image {
        const char *part, *name;
        double best, triangles;
    };
    for (const Image& image :
         {Image{"first_primary_s", "first image from cold, primary", kColdPrimary, kColdPrimaryTriangles},
          {"first_occlusion_s", "first image from cold, and occlusion", kColdSecond, kColdSecondTriangles},
          {"first_diffuse_s", "first image from cold, and one bounce", kColdSecond, kColdSecondTriangles}}) {
        const auto own = get_median(cold["relief"], image.part);
        goals.add_least(fmt::format("{}, best of Embree", image.name), image.best,
                        find_best(cold, image.part), own);
        if (cold.contains("triangles"))
            goals.add_least(fmt::format("{}, Embree's triangles", image.name), image.triangles,
                            get_median(cold["triangles"], image.part), own);
    }
}

void add_cast_goals(const Value& cast, const std::string& isa, int threads, GoalList& goals) {
    const std::string rays = cast["rays"].get<std::string>();
    const std::string call = cast["kind"] == "any" ? "rtcOccluded" : "rtcIntersect";
    const auto relief = [&](const char* way, const std::string& set, int count) {
        return find_seconds(cast, {"relief", way, "", set, count});
    };
    const auto embree = [&](const char* way, int width) {
        const std::string name = fmt::format("{}{}", call, width);
        return find_seconds(cast, {"embree", way, name, "", threads});
    };
    const auto own = relief("rays", isa, threads);
    if (rays == "primary") {
        const char* frame = "frame_from_empty_cache";
        goals.add_least("pinhole primary, all work of the frame, rtcIntersect16 on triangles", kPinhole,
                        embree("triangles", 16), relief(frame, isa, threads));
        goals.add_least("threads, pinhole primary", 0.5 * threads * kTwoThreads, relief(frame, isa, 1),
                        relief(frame, isa, threads));
        goals.add_least("avx2 of avx512, pinhole primary", kAvx2, relief(frame, "avx512", threads),
                        relief(frame, "avx2", threads));
    } else if (cast["coherent"].get<bool>()) {
        goals.add_least(fmt::format("{}, {}16 on triangles", rays, call), kCoherent, embree("triangles", 16),
                        own);
    } else {
        goals.add_least(fmt::format("{}, {}1 on triangles", rays, call), kIncoherent, embree("triangles", 1),
                        own);
        goals.add_least(fmt::format("{}, {}1 on grids", rays, call), kIncoherentGrid, embree("grid", 1), own);
    }
    if (threads > 1)
        goals.add_least(fmt::format("threads, {}", rays), 0.5 * threads * kTwoThreads, relief("rays", isa, 1),
                        own);
    goals.add_least(fmt::format("avx2 of avx512, {}", rays), kAvx2, relief("rays", "avx512", threads),
                    relief("rays", "avx2", threads));
}

void add_bounce_goal(const Value& bounces, GoalList& goals) {
    std::optional<double> first, last;
    for (const Value& bounce : bounces) {
        if (bounce["depth"] == 1) first = bounce["seconds_a_ray"].get<double>();
        if (bounce["depth"] == 5) last = bounce["seconds_a_ray"].get<double>();
    }
    if (first && last && *first > 0)
        goals.add_most("bounce 5 against bounce 1, time a ray", kPeersDepthRatio, *last / *first, "times");
}

/// Rays that differ from Embree's triangles other than at edges or at grazing angles, or from the tessellated
/// surface at all.
void add_agreement_goal(const Value& agreements, GoalList& goals) {
    double unexplained = 0;
    bool has_any = false;
    for (const Value& a : agreements)
        if (a["against"] == "Embree triangles" || a["against"] == "tessellated") {
            has_any = true;
            unexplained += a["missed"].get<double>() + a["extra"].get<double>() + a["depth"].get<double>() -
                           a["at_edges"].get<double>() - a["grazing"].get<double>();
        }
    if (has_any) goals.add_most("hits that differ beyond rounding", 0, unexplained, "rays");
}

} // namespace

Value make_peers_goals(const Value& result) {
    GoalList goals;
    if (result.contains("party"))
        goals.add_most("party, peak resident of this process, making the scene included",
                       kPeersPartyMebibytes, result["party"]["peak_resident_bytes"].get<double>() / (1 << 20),
                       "MiB");
    const auto is_goal_level = [](const Value& scene) {
        return scene["level"] == "5" || scene["level"] == "auto";
    };
    const Value& scenes = result["scenes"];
    const bool has_goal_level = std::any_of(scenes.begin(), scenes.end(), is_goal_level);
    for (const Value& scene : scenes) {
        if (has_goal_level && !is_goal_level(scene)) continue;
        goals.set_place(scene);
        const Value& memory = scene["memory"];
        for (const auto& [part, goal] :
             {std::pair("bytes_a_patch", kPeersBytesAPatch), {"bytes_a_micro_quad", kBytesAMicroQuad}})
            if (memory.contains(part)) goals.add_most(part, goal, memory[part].get<double>(), "bytes");
        add_agreement_goal(scene["agreement"], goals);
        add_cold_goals(scene["cold"], goals);
        for (const Value& cast : scene["casts"])
            add_cast_goals(cast, scene["isa"].get<std::string>(), result["settings"]["threads"].get<int>(),
                           goals);
        add_bounce_goal(scene["bounces"], goals);
    }
    return goals.take();
}

} // namespace relief::bench
