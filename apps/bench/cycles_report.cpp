// The files of a result of cycles.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/bar_chart.h"
#include "bench/cycles.h"

namespace relief::bench {

namespace {

using Json = nlohmann::ordered_json;

std::string get_where(const Json& result) {
    const Json& settings = result["settings"];
    return fmt::format("{} x {} pixels, {} threads, {}; Blender {}; commit {}", settings["width"].get<int>(),
                       settings["height"].get<int>(), settings["threads"].get<int>(),
                       result["machine"]["processor"].get<std::string>(),
                       result["blender"].get<std::string>(), result["build"]["commit"].get<std::string>());
}

std::string describe_map(const Json& entry) {
    const Json& map = entry["importance_map"];
    return map.is_string() ? map.get<std::string>() : std::to_string(map.get<int>());
}

std::string get_title(const Json& entry) {
    return fmt::format("{} samples, {} bounces", entry["samples"].get<int>(), entry["bounces"].get<int>());
}

/// Preparation, the first sample, the others.
Bar make_time_bar(const char* label, const Json& side) {
    const auto get = [&](const char* measure, const char* part) {
        return 1e3 * side[measure][part].get<double>();
    };
    const double prepare = get("prepare_s", "median"), first = get("first_sample_s", "median");
    return {label,
            {prepare, first - prepare, get("render_s", "median") - first},
            "",
            get("render_s", "lowest"),
            get("render_s", "highest")};
}

Chart make_time_chart(const Json& result, const Json& scene) {
    Chart chart{"Cycles and Relief: " + scene["scene"].get<std::string>(),
                "from the scene in memory to the picture",
                Unit::milliseconds,
                Scale::linear,
                {"preparation", "first sample", "the others"},
                {},
                {get_where(result), "Every panel has an axis of its own."}};
    for (const Json& entry : scene["cases"])
        chart.panels.push_back(
            {get_title(entry),
             "importance map: " + describe_map(entry),
             {make_time_bar("Cycles", entry["cycles"]), make_time_bar("Relief", entry["relief"])}});
    return chart;
}

Bar make_memory_bar(const char* label, const Json& peak) {
    return {label, {peak["median"].get<double>()}, "", peak["lowest"], peak["highest"]};
}

Chart make_memory_chart(const Json& result) {
    Chart chart{"Peak resident memory", "bytes of the process", Unit::bytes, Scale::linear, {"resident"}, {},
                {get_where(result)}};
    for (const Json& scene : result["scenes"]) {
        const Json& entry = scene["cases"][3];
        chart.panels.push_back({scene["scene"],
                                get_title(entry),
                                {make_memory_bar("Cycles", entry["cycles"]["resident_peak_bytes"]),
                                 make_memory_bar("Relief", entry["relief"]["resident_peak_bytes"])}});
    }
    return chart;
}

std::string make_csv(const Json& result) {
    std::string text = "scene,samples,bounces,importance_map,program,measure,median,lowest,highest\n";
    for (const Json& scene : result["scenes"])
        for (const Json& entry : scene["cases"])
            for (const char* side : {"cycles", "relief"})
                for (const auto& [measure, summary] : entry[side].items())
                    text += fmt::format("{},{},{},{},{},{},{},{},{}\n", scene["scene"].get<std::string>(),
                                        entry["samples"].get<int>(), entry["bounces"].get<int>(),
                                        describe_map(entry), side, measure, summary["median"].get<double>(),
                                        summary["lowest"].get<double>(), summary["highest"].get<double>());
    return text;
}

} // namespace

std::vector<ReportFile> make_cycles_files(const Json& result) {
    std::vector<ReportFile> files = {{"cycles.json", result.dump(1) + "\n"},
                                     {"cycles.csv", make_csv(result)},
                                     {"cycles_memory.svg", make_bar_chart(make_memory_chart(result))}};
    for (const Json& scene : result["scenes"])
        files.push_back({fmt::format("cycles_{}.svg", scene["scene"].get<std::string>()),
                         make_bar_chart(make_time_chart(result, scene))});
    return files;
}

} // namespace relief::bench
