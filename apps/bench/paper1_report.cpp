// The result of the suite as files: JSON, CSV, and a chart for the table and each figure.
#include <array>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/bar_chart.h"
#include "bench/paper1.h"

namespace relief::bench {

namespace {

using Json = nlohmann::ordered_json;

using Stage = std::pair<const char*, const char*>; ///< key of the JSON, words of the legend

constexpr std::array<Stage, 6> kFrameStages = {{{"top_traversal", "top and middle cast"},
                                                {"sort", "sort"},
                                                {"bottom_build", "bottom build"},
                                                {"bottom_traversal", "bottom cast"},
                                                {"shade", "shading"},
                                                {"film", "film"}}};
constexpr size_t kCastStageCount = 4; ///< those of kFrameStages that a cast has

std::vector<std::string> get_legend(size_t count) {
    std::vector<std::string> legend;
    for (size_t k = 0; k < count; ++k) legend.emplace_back(kFrameStages[k].second);
    return legend;
}

std::string get_axis(const Json& result, const std::string& what) {
    if (result["device"]["engine"] == "vulkan") return what + ", time of the device";
    return fmt::format("{}, summed over {} threads", what, result["device"]["threads"].get<int>());
}

std::string get_where(const Json& result) {
    return fmt::format("Relief {}, {} ({}), {}x{}, medians of {} runs; level {}",
                       result["build"]["commit"].get<std::string>(),
                       result["device"]["name"].get<std::string>(),
                       result["device"]["engine"].get<std::string>(), result["settings"]["width"].get<int>(),
                       result["settings"]["height"].get<int>(), result["settings"]["runs"].get<int>(),
                       result["settings"]["level"].get<std::string>());
}

std::vector<std::string> get_notes(const Json& result, const std::string& figure) {
    std::vector<std::string> notes = {get_where(result)};
    for (const Json& statement : result["paper_says"])
        if (statement["about"] == figure) notes.push_back("Paper: " + statement["text"].get<std::string>());
    return notes;
}

Bar make_stage_bar(const std::string& label, const Json& entry, size_t stage_count, const char* total) {
    Bar bar{label,
            {},
            "",
            1e3 * entry[total]["lowest"].get<double>(),
            1e3 * entry[total]["highest"].get<double>()};
    for (size_t k = 0; k < stage_count; ++k)
        bar.values.push_back(1e3 * entry["stage_s"][kFrameStages[k].first]["median"].get<double>());
    return bar;
}

/// A bar of one colour.
Bar make_bytes_bar(const std::string& label, size_t series, double bytes) {
    Bar bar{label, std::vector<double>(4, 0.0), "", 0, 0};
    bar.values[series] = bytes;
    return bar;
}

Chart make_table_chart(const Json& result) {
    Chart chart{"Table 1.1: geometry and acceleration structures, direct against pre-tessellated",
                "bytes, maps apart, logarithmic",
                Unit::bytes,
                Scale::logarithmic,
                {"Relief, direct (allocated)", "paper, direct", "Relief, pre-tessellated (estimate)",
                 "paper, pre-tessellated"},
                {},
                {get_where(result)}};
    for (const Json& row : result["table1_1"]) {
        Panel panel{row["scene"].get<std::string>(),
                    fmt::format("{} patches, {:.1f} bytes each", row["patches"].get<uint64_t>(),
                                row["direct"]["bytes_a_patch"].get<double>()),
                    {}};
        panel.bars.push_back(make_bytes_bar("direct", 0, row["direct"]["total_bytes"].get<double>()));
        panel.bars.push_back(make_bytes_bar("paper", 1, row["paper"]["direct_bytes"].get<double>()));
        for (const Json& cost : row["tessellated_estimate"])
            panel.bars.push_back(make_bytes_bar("level " + cost["level"].get<std::string>(), 2,
                                                cost["total_bytes"].get<double>()));
        panel.bars.push_back(make_bytes_bar("paper", 3, row["paper"]["tessellated_bytes"].get<double>()));
        chart.panels.push_back(std::move(panel));
    }
    return chart;
}

Chart make_frame_chart(const Json& result) {
    Chart chart{"Figure 1.7: breakdown of a frame, one primary and one shadow ray a pixel",
                get_axis(result, "time of a frame"),
                Unit::milliseconds,
                Scale::linear,
                get_legend(kFrameStages.size()),
                {},
                get_notes(result, "figure1_7")};
    for (const Json& scene : result["figure1_7"]) {
        Panel panel{scene["scene"].get<std::string>(), "", {}};
        for (const Json& variant : scene["variants"]) {
            const std::string name = variant["name"].get<std::string>();
            if (variant["outcome"] == "measured") {
                panel.bars.push_back(make_stage_bar(name, variant, kFrameStages.size(), "stages_total_s"));
                continue;
            }
            const double bytes = scene["tessellated_peak_bytes"].get<double>();
            panel.bars.push_back({name, {}, "not made: " + format_value(Unit::bytes, bytes), 0, 0});
        }
        chart.panels.push_back(std::move(panel));
    }
    return chart;
}

Chart make_cast_chart(const Json& result) {
    Chart chart{"Figure 1.9: top and middle cast, sort, bottom cast",
                get_axis(result, "time of a cast"),
                Unit::milliseconds,
                Scale::linear,
                get_legend(kCastStageCount),
                {},
                get_notes(result, "figure1_9")};
    for (const Json& scene : result["figure1_9"]) {
        Panel panel{scene["scene"].get<std::string>(), "", {}};
        for (const Json& variant : scene["variants"])
            for (const Json& cast : variant["casts"]) {
                const std::string kind = cast["kind"] == "shadow" ? "shadow" : "primary";
                const std::string cache = variant["name"] == "direct" ? ", cache" : "";
                panel.bars.push_back(make_stage_bar(kind + cache, cast, kCastStageCount, "total_s"));
            }
        chart.panels.push_back(std::move(panel));
    }
    return chart;
}

Chart make_depth_chart(const Json& result) {
    Chart chart{"Figure 1.10: casts by depth of the path, Bark in white",
                get_axis(result, "time of a cast; (sh): shadow rays"),
                Unit::milliseconds,
                Scale::linear,
                get_legend(kCastStageCount),
                {},
                get_notes(result, "figure1_10")};
    for (const Json& scene : result["figure1_10"])
        for (const Json& variant : scene["variants"]) {
            Panel panel{variant["name"] == "direct" ? "with the cache" : "no cache, as in the paper", "", {}};
            for (const Json& cast : variant["casts"])
                panel.bars.push_back(make_stage_bar(
                    fmt::format("{}{}", cast["depth"].get<int>(), cast["kind"] == "shadow" ? " (sh)" : ""),
                    cast, kCastStageCount, "total_s"));
            chart.panels.push_back(std::move(panel));
        }
    return chart;
}

/// Of the Vulkan engine alone.
Chart make_form_chart(const Json& result) {
    Chart chart{"A frame by form of the bottom level: split or fused",
                get_axis(result, "time of a frame"),
                Unit::milliseconds,
                Scale::linear,
                get_legend(kFrameStages.size()),
                {},
                {get_where(result), "Fused: trees are built within the bottom cast."}};
    for (const Json& scene : result["bottom_forms"]) {
        Panel panel{scene["scene"].get<std::string>(), "", {}};
        for (const Json& variant : scene["variants"])
            panel.bars.push_back(make_stage_bar(variant["name"].get<std::string>(), variant,
                                                kFrameStages.size(), "stages_total_s"));
        chart.panels.push_back(std::move(panel));
    }
    return chart;
}

/// One measure a line; names with a comma stand in quotes.
class CsvWriter {
  public:
    std::string write(const Json& result) {
        text_ = "part,scene,variant,depth,kind,measure,unit,median,lowest,highest\n";
        for (const Json& row : result["table1_1"]) add_table_row(row);
        for (const Json& scene : result["figure1_7"])
            for (const Json& variant : scene["variants"])
                if (variant["outcome"] == "measured") add_frames("figure1_7", scene["scene"], variant);
        if (result.contains("bottom_forms"))
            for (const Json& scene : result["bottom_forms"])
                for (const Json& variant : scene["variants"])
                    add_frames("bottom_forms", scene["scene"], variant);
        for (const char* figure : {"figure1_9", "figure1_10"})
            for (const Json& scene : result[figure])
                for (const Json& variant : scene["variants"])
                    for (const Json& cast : variant["casts"]) add_cast(figure, scene["scene"], variant, cast);
        return std::move(text_);
    }

  private:
    void add_bytes(const Json& row, const std::string& variant, const Json& bytes) {
        text_ += fmt::format("table1_1,{},\"{}\",,,total,bytes,{},,\n", row["scene"].get<std::string>(),
                             variant, bytes.get<double>());
    }

    void add_table_row(const Json& row) {
        add_bytes(row, "direct", row["direct"]["total_bytes"]);
        add_bytes(row, "paper, direct", row["paper"]["direct_bytes"]);
        for (const Json& cost : row["tessellated_estimate"])
            add_bytes(row, "tessellated, level " + cost["level"].get<std::string>(), cost["total_bytes"]);
        add_bytes(row, "paper, tessellated", row["paper"]["tessellated_bytes"]);
    }

    void add_summary(const std::string& begin, const std::string& measure, const Json& summary) {
        text_ += fmt::format("{},{},s,{},{},{}\n", begin, measure, summary["median"].get<double>(),
                             summary["lowest"].get<double>(), summary["highest"].get<double>());
    }

    void add_frames(const char* part, const std::string& scene, const Json& variant) {
        const std::string begin =
            fmt::format("{},{},\"{}\",,", part, scene, variant["name"].get<std::string>());
        add_summary(begin, "frame", variant["frame_s"]);
        add_summary(begin, "prepare", variant["prepare_s"]);
        for (const auto& [stage, summary] : variant["stage_s"].items()) add_summary(begin, stage, summary);
    }

    void add_cast(const char* figure, const std::string& scene, const Json& variant, const Json& cast) {
        const std::string begin =
            fmt::format("{},{},\"{}\",{},{}", figure, scene, variant["name"].get<std::string>(),
                        cast["depth"].get<int>(), cast["kind"].get<std::string>());
        for (const auto& [stage, summary] : cast["stage_s"].items()) add_summary(begin, stage, summary);
        add_summary(begin, "total", cast["total_s"]);
    }

    std::string text_;
};

} // namespace

std::vector<ReportFile> make_paper1_files(const Json& result) {
    std::vector<ReportFile> files = {{"paper1.json", result.dump(1) + "\n"},
                                     {"paper1.csv", CsvWriter().write(result)},
                                     {"paper1_table1.svg", make_bar_chart(make_table_chart(result))},
                                     {"paper1_figure1_7.svg", make_bar_chart(make_frame_chart(result))},
                                     {"paper1_figure1_9.svg", make_bar_chart(make_cast_chart(result))},
                                     {"paper1_figure1_10.svg", make_bar_chart(make_depth_chart(result))}};
    if (result.contains("bottom_forms"))
        files.push_back({"paper1_bottom_forms.svg", make_bar_chart(make_form_chart(result))});
    return files;
}

} // namespace relief::bench
