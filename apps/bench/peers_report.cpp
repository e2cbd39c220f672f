// The result of the suite as files: JSON, CSV, the table of goals, and for each scene a chart of first images
// and one of rays.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/bar_chart.h"
#include "bench/peers.h"
#include "bench/peers_goals.h"

namespace relief::bench {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kMilliseconds = 1e3;

std::string get_where(const Json& result) {
    return fmt::format("Relief {}, Embree {}, {}, {} threads, {}x{}, medians of {} runs",
                       result["build"]["commit"].get<std::string>(),
                       result["embree_version"].get<std::string>(),
                       result["machine"]["processor"].get<std::string>(),
                       result["settings"]["threads"].get<int>(), result["settings"]["width"].get<int>(),
                       result["settings"]["height"].get<int>(), result["settings"]["runs"].get<int>());
}

double get_median(const Json& parts, const char* part) {
    return parts.contains(part) ? kMilliseconds * parts[part]["median"].get<double>() : 0;
}

/// A bar for each program: what passes until the first image with one occlusion ray a hit.
Panel make_cold_panel(const Json& scene) {
    Panel panel{"level " + scene["level"].get<std::string>(), "", {}};
    for (const auto& [way, cold] : scene["cold"].items()) {
        Bar bar{way,
                {get_median(cold, "tessellate_s") + get_median(cold, "prepare_s"),
                 get_median(cold, "build_s"), get_median(cold, "primary_s"), get_median(cold, "occlusion_s")},
                "",
                kMilliseconds * cold["first_occlusion_s"]["lowest"].get<double>(),
                kMilliseconds * cold["first_occlusion_s"]["highest"].get<double>()};
        panel.bars.push_back(std::move(bar));
    }
    return panel;
}

/// Relief with all threads, and Embree's ways by one ray and by sixteen.
Panel make_cast_panel(const Json& cast, int threads, const std::string& isa) {
    Panel panel{cast["rays"].get<std::string>(), "", {}};
    for (const Json& way : cast["ways"]) {
        if (way["threads"] != threads || (way.contains("isa") && way["isa"] != isa)) continue;
        const std::string call = way.value("call", "");
        if (call.ends_with("8")) continue;
        const std::string width = call.empty() ? "" : call.ends_with("16") ? " x16" : " x1";
        const std::string name = way["program"] == "relief" ? "relief " : "";
        panel.bars.push_back({name + way["way"].get<std::string>() + width,
                              {get_median(way, "seconds")},
                              "",
                              kMilliseconds * way["seconds"]["lowest"].get<double>(),
                              kMilliseconds * way["seconds"]["highest"].get<double>()});
    }
    return panel;
}

std::string make_cold_chart(const Json& result, const std::string& name) {
    Chart chart;
    chart.title = name + ": first image from cold, one occlusion ray a hit";
    chart.axis = "wall clock";
    chart.series = {"prepare or tessellate", "build", "primary rays", "occlusion rays"};
    for (const Json& scene : result["scenes"])
        if (scene["scene"] == name) chart.panels.push_back(make_cold_panel(scene));
    chart.notes = {get_where(result)};
    return make_bar_chart(chart);
}

std::string make_cast_chart(const Json& result, const Json& scene) {
    Chart chart;
    chart.title = fmt::format("{}, level {}: the same rays, warm", scene["scene"].get<std::string>(),
                              scene["level"].get<std::string>());
    chart.axis = "wall clock";
    chart.series = {"all rays of the kind"};
    for (const Json& cast : scene["casts"])
        chart.panels.push_back(make_cast_panel(cast, result["settings"]["threads"], scene["isa"]));
    chart.notes = {get_where(result)};
    return make_bar_chart(chart);
}

void add_line(const Json& scene, const std::string& part, const std::string& labels,
              const std::string& measure, const Json& value, std::string& csv) {
    csv +=
        fmt::format("{},{},{},{},{},{:.6g},{:.6g},{:.6g}\n", scene["scene"].get<std::string>(),
                    scene["level"].get<std::string>(), part, labels, measure, value["median"].get<double>(),
                    value["lowest"].get<double>(), value["highest"].get<double>());
}

std::string make_csv(const Json& result) {
    std::string csv = "scene,level,part,rays,program,way,call,threads,isa,measure,median,lowest,highest\n";
    const int all = result["settings"]["threads"];
    for (const Json& scene : result["scenes"]) {
        for (const auto& [way, cold] : scene["cold"].items())
            for (const auto& [measure, value] : cold.items())
                add_line(scene, "cold",
                         fmt::format(",{},{},,{},", way == "relief" ? "relief" : "embree", way, all), measure,
                         value, csv);
        for (const Json& cast : scene["casts"])
            for (const Json& way : cast["ways"])
                add_line(scene, "cast",
                         fmt::format("{},{},{},{},{},{}", cast["rays"].get<std::string>(),
                                     way["program"].get<std::string>(), way["way"].get<std::string>(),
                                     way.value("call", ""), way["threads"].get<int>(), way.value("isa", "")),
                         "seconds", way["seconds"], csv);
        for (const Json& bounce : scene["bounces"])
            add_line(scene, "path",
                     fmt::format("bounce {},relief,path,,{},", bounce["depth"].get<int>(), all),
                     "thread_seconds", bounce["total_s"], csv);
    }
    return csv;
}

/// Names of files: scenes of the user's may be called anything.
std::string make_stem(size_t number, const std::string& name) {
    const std::vector<std::string> known = peers_scene_names();
    return std::find(known.begin(), known.end(), name) != known.end() ? name : fmt::format("scene{}", number);
}

} // namespace

std::vector<ReportFile> make_peers_files(const Json& result) {
    std::vector<ReportFile> files = {{"peers.json", result.dump(1) + "\n"},
                                     {"peers.csv", make_csv(result)},
                                     {"peers_goals.md", make_goal_table(result["goals"])}};
    std::vector<std::string> names;
    for (const Json& scene : result["scenes"]) {
        const std::string name = scene["scene"];
        const bool is_new = std::find(names.begin(), names.end(), name) == names.end();
        if (is_new) names.push_back(name);
        const std::string stem = make_stem(names.size() - 1, name);
        if (is_new) files.push_back({fmt::format("peers_{}_cold.svg", stem), make_cold_chart(result, name)});
        files.push_back({fmt::format("peers_{}_{}_rays.svg", stem, scene["level"].get<std::string>()),
                         make_cast_chart(result, scene)});
    }
    return files;
}

} // namespace relief::bench
