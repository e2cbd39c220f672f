// The files of a result of paper3.
#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/bar_chart.h"
#include "bench/paper3.h"

namespace relief::bench {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kStages[] = {"top_traversal",    "sort",  "bottom_build",
                                   "bottom_traversal", "shade", "film"};

std::string get_where(const Json& result) {
    const Json& settings = result["settings"];
    const std::string device = result.contains("device") ? result["device"]["name"].get<std::string>() : "";
    return fmt::format("{}, {}; {} x {} pixels; commit {}", settings["engine"].get<std::string>(), device,
                       settings["width"].get<int>(), settings["height"].get<int>(),
                       result["build"]["commit"].get<std::string>());
}

std::string get_pair(const Json& way) {
    return fmt::format("{} {}", way["structure"].get<std::string>(), way["traversal"].get<std::string>());
}

bool is_measured(const Json& way) { return way["outcome"] == "measured"; }

Bar make_frame_bar(const Json& way) {
    Bar bar{way["method"].get<std::string>(), {}, "", 0, 0};
    if (!is_measured(way)) {
        bar.note = "refused";
        return bar;
    }
    for (const char* stage : kStages)
        bar.values.push_back(1e3 * way["stage_s"][stage]["median"].get<double>());
    bar.lowest = 1e3 * way["stages_total_s"]["lowest"].get<double>();
    bar.highest = 1e3 * way["stages_total_s"]["highest"].get<double>();
    return bar;
}

/// A panel for each structure and traversal, a bar for each method.
Chart make_frame_chart(const Json& result, const Json& scene) {
    Chart chart{"A frame of " + scene["scene"].get<std::string>() +
                    ": one primary and one shadow ray a pixel",
                "time by stage",
                Unit::milliseconds,
                Scale::linear,
                {kStages, kStages + std::size(kStages)},
                {},
                {get_where(result), "Every panel has an axis of its own."}};
    for (const Json& way : scene["ways"]) {
        const std::string pair = get_pair(way);
        if (chart.panels.empty() || chart.panels.back().title != pair) chart.panels.push_back({pair, "", {}});
        chart.panels.back().bars.push_back(make_frame_bar(way));
    }
    return chart;
}

/// Bytes do not depend on the method.
Chart make_bytes_chart(const Json& result) {
    Chart chart{"Bytes of a scene by structure", "bytes", Unit::bytes,        Scale::linear,
                {"geometry", "structures"},      {},      {get_where(result)}};
    for (const Json& scene : result["scenes"]) {
        Panel panel{scene["scene"].get<std::string>(), "", {}};
        for (const Json& way : scene["ways"])
            if (is_measured(way) && way["method"] == "compute")
                panel.bars.push_back(
                    {get_pair(way),
                     {way["geometry_bytes"].get<double>(), way["structures_bytes"].get<double>()},
                     "",
                     0,
                     0});
        chart.panels.push_back(std::move(panel));
    }
    return chart;
}

void add_time(std::string& text, const std::string& begin, const std::string& measure, const Json& summary) {
    text += fmt::format("{},{},s,{},{},{}\n", begin, measure, summary["median"].get<double>(),
                        summary["lowest"].get<double>(), summary["highest"].get<double>());
}

std::string make_csv(const Json& result) {
    std::string text = "scene,structure,traversal,method,measure,unit,median,lowest,highest\n";
    for (const Json& scene : result["scenes"])
        for (const Json& way : scene["ways"]) {
            if (!is_measured(way)) continue;
            const std::string begin = fmt::format(
                "\"{}\",{},{},{}", scene["scene"].get<std::string>(), way["structure"].get<std::string>(),
                way["traversal"].get<std::string>(), way["method"].get<std::string>());
            add_time(text, begin, "frame", way["frame_s"]);
            add_time(text, begin, "prepare", way["prepare_s"]);
            for (const auto& [stage, summary] : way["stage_s"].items()) add_time(text, begin, stage, summary);
            for (const char* bytes : {"geometry_bytes", "structures_bytes", "ray_buffers_bytes"})
                text += fmt::format("{},{},bytes,{},,\n", begin, bytes, way[bytes].get<double>());
        }
    return text;
}

} // namespace

std::vector<ReportFile> make_paper3_files(const Json& result) {
    std::vector<ReportFile> files = {{"paper3.json", result.dump(1) + "\n"},
                                     {"paper3.csv", make_csv(result)},
                                     {"paper3_bytes.svg", make_bar_chart(make_bytes_chart(result))}};
    const std::vector<std::string> known = paper3_scenes();
    for (size_t k = 0; k < result["scenes"].size(); ++k) {
        const std::string name = result["scenes"][k]["scene"];
        const bool is_known = std::find(known.begin(), known.end(), name) != known.end();
        files.push_back({fmt::format("paper3_{}.svg", is_known ? name : fmt::format("mesh{}", k)),
                         make_bar_chart(make_frame_chart(result, result["scenes"][k]))});
    }
    return files;
}

} // namespace relief::bench
