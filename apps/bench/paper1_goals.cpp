#include "bench/paper1_goals.h"

#include <algorithm>
#include <optional>
#include <string>

namespace relief::bench {

namespace {

constexpr double kBytesAPatch = 64, kPartyPeakMebibytes = 448, kDepthRatio = 1.3, kPartyFrameMilliseconds = 5;

void add_goal(Value& goals, const std::string& name, double goal, double reached, const char* unit) {
    goals.push_back(
        {{"name", name}, {"goal", goal}, {"reached", reached}, {"unit", unit}, {"met", reached <= goal}});
}

const Value* find_variant(const Value& scene, const std::string& name) {
    for (const Value& variant : scene["variants"])
        if (variant["name"] == name) return &variant;
    return nullptr;
}

/// Seconds per bounce ray at `depth`, without shadow rays.
std::optional<double> compute_seconds_a_ray(const Value& casts, int depth) {
    for (const Value& cast : casts)
        if (cast["depth"] == depth && cast["kind"] == "bounce")
            return cast["total_s"]["median"].get<double>() / cast["rays"].get<double>();
    return std::nullopt;
}

void add_depth_goal(const Value& figure, Value& goals) {
    for (const Value& scene : figure) {
        const Value* direct = find_variant(scene, "direct");
        if (!direct) continue;
        const auto first = compute_seconds_a_ray((*direct)["casts"], 1);
        const auto last = compute_seconds_a_ray((*direct)["casts"], 5);
        if (first && last && *first > 0)
            add_goal(goals, "bounce 5 against bounce 1, time a ray, with the cache", kDepthRatio,
                     *last / *first, "ratio");
    }
}

/// Direct tracing against the same kernels on pre-tessellated micro-quads, where measured.
void add_tessellated_goals(const Value& figure, Value& goals) {
    for (const Value& scene : figure) {
        const Value *direct = find_variant(scene, "direct"), *flat = find_variant(scene, "tessellated");
        if (!direct || !flat || (*direct)["outcome"] != "measured" || (*flat)["outcome"] != "measured")
            continue;
        add_goal(goals, scene["scene"].get<std::string>() + ", direct against pre-tessellated, frame", 1,
                 (*direct)["frame_s"]["median"].get<double>() / (*flat)["frame_s"]["median"].get<double>(),
                 "ratio");
    }
}

} // namespace

Value make_paper1_goals(const Value& result) {
    Value goals = Value::list();
    double bytes_a_patch = 0;
    for (const Value& row : result["table1_1"])
        bytes_a_patch = std::max(bytes_a_patch, row["direct"]["bytes_a_patch"].get<double>());
    add_goal(goals, "geometry and structures a displaced patch, worst scene", kBytesAPatch, bytes_a_patch,
             "bytes");
    if (result.contains("party"))
        add_goal(goals, "party, peak resident of this process, making the scene included",
                 kPartyPeakMebibytes, result["party"]["peak_resident_bytes"].get<double>() / (1 << 20),
                 "MiB");
    add_depth_goal(result["figure1_10"], goals);
    if (result["device"]["engine"] != "vulkan") return goals;
    if (result.contains("party") && result["party"].contains("frame_s"))
        add_goal(goals, "party, primary and shadow rays, frame", kPartyFrameMilliseconds,
                 1e3 * result["party"]["frame_s"]["median"].get<double>(), "ms");
    add_tessellated_goals(result["figure1_7"], goals);
    return goals;
}

} // namespace relief::bench
