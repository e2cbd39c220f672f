// The files of a result of paper2.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/bar_chart.h"
#include "bench/paper2.h"

namespace relief::bench {

namespace {

using Json = nlohmann::ordered_json;

std::string get_where(const Json& result) {
    const Json& settings = result["settings"];
    std::string device = result["meshes"].empty() ? "" : result["meshes"][0]["device"].get<std::string>();
    const int asked = settings["threads"].get<int>(); // 0: all
    const int threads = asked > 0 ? asked : result["machine"]["threads"].get<int>();
    return fmt::format("{}, {}, {} threads; {} x {} primary rays; commit {}",
                       settings["engine"].get<std::string>(), device, threads, settings["width"].get<int>(),
                       settings["height"].get<int>(), result["build"]["commit"].get<std::string>());
}

Panel make_panel(const Json& mesh) {
    return {
        mesh["mesh"].get<std::string>(), fmt::format("{} triangles", mesh["triangles"].get<uint64_t>()), {}};
}

Bar make_time_bar(const std::string& label, const Json& seconds, double factor) {
    Bar bar{label, {factor * seconds["median"].get<double>()}, "", 0, 0};
    bar.lowest = factor * seconds["lowest"].get<double>();
    bar.highest = factor * seconds["highest"].get<double>();
    return bar;
}

Chart make_build_chart(const Json& result) {
    Chart chart{"Building a tree", "time", Unit::milliseconds, Scale::logarithmic,
                {"build"},         {},     {get_where(result)}};
    for (const Json& mesh : result["meshes"]) {
        Panel panel = make_panel(mesh);
        for (const Json& build : mesh["builds"])
            panel.bars.push_back(make_time_bar(build["tree"].get<std::string>() +
                                                   (build["built_on"] == "device" ? " (device)" : ""),
                                               build["seconds"], 1e3));
        chart.panels.push_back(std::move(panel));
    }
    return chart;
}

Chart make_bytes_chart(const Json& result) {
    Chart chart{"Bytes a triangle, triangles not counted",
                "bytes",
                Unit::bytes,
                Scale::linear,
                {"nodes, directory, ids", "links or cells"},
                {},
                {get_where(result),
                 "Links are those of parent or of skip links, one of them; cells those of backtrack."}};
    for (const Json& mesh : result["meshes"]) {
        Panel panel = make_panel(mesh);
        const double triangles = mesh["triangles"];
        for (const Json& build : mesh["builds"])
            panel.bars.push_back(
                {build["tree"].get<std::string>(),
                 {build["bytes_a_triangle"].get<double>(), build["link_bytes"].get<double>() / triangles},
                 "",
                 0,
                 0});
        chart.panels.push_back(std::move(panel));
    }
    for (const Json& model : result["paper_models"])
        chart.notes.push_back(fmt::format("The paper's heap: {}, {:.0f} bytes a triangle.",
                                          model["model"].get<std::string>(),
                                          model["bytes_a_triangle"].get<double>()));
    return chart;
}

/// One kind of rays over one mesh, a panel for each tree.
Chart make_cast_chart(const Json& result, const Json& mesh, const std::string& rays) {
    const double count = mesh["rays"][rays];
    Chart chart{fmt::format("{} rays, {}", rays, mesh["mesh"].get<std::string>()),
                "time of a million rays",
                Unit::milliseconds,
                Scale::linear,
                {"walk and triangle tests"},
                {},
                {get_where(result), "Every panel has an axis of its own."}};
    for (const Json& cast : mesh["casts"]) {
        if (cast["rays"] != rays) continue;
        const std::string tree = cast["tree"];
        if (chart.panels.empty() || chart.panels.back().title != tree) chart.panels.push_back({tree, "", {}});
        std::string label = cast["traversal"];
        if (cast["start"] == "last hit") label += ", last hit";
        chart.panels.back().bars.push_back(make_time_bar(label, cast["seconds"], 1e9 / count));
    }
    return chart;
}

/// One measure a line; names with a blank stand in quotes.
class CsvWriter {
  public:
    std::string write(const Json& result) {
        text_ = "mesh,part,tree,traversal,rays,start,measure,unit,median,lowest,highest\n";
        for (const Json& mesh : result["meshes"]) {
            for (const Json& build : mesh["builds"]) add_build(mesh["mesh"], build);
            for (const Json& cast : mesh["casts"]) add_cast(mesh["mesh"], cast);
        }
        return std::move(text_);
    }

  private:
    void add_summary(const std::string& begin, const std::string& measure, const char* unit,
                     const Json& summary) {
        text_ += fmt::format("{},{},{},{},{},{}\n", begin, measure, unit, summary["median"].get<double>(),
                             summary["lowest"].get<double>(), summary["highest"].get<double>());
    }

    void add_value(const std::string& begin, const char* measure, const char* unit, const Json& value) {
        text_ += fmt::format("{},{},{},{},,\n", begin, measure, unit, value.get<double>());
    }

    void add_build(const std::string& mesh, const Json& build) {
        const std::string begin =
            fmt::format("\"{}\",build,\"{}\",,,", mesh, build["tree"].get<std::string>());
        add_summary(begin, "build", "s", build["seconds"]);
        for (const char* bytes : {"bytes", "link_bytes", "bytes_a_triangle"})
            add_value(begin, bytes, "bytes", build[bytes]);
        for (const char* number : {"slots", "used_slots", "used_share", "entries_a_triangle", "depth"})
            add_value(begin, number, "1", build[number]);
        if (!build.contains("parts")) return;
        for (const Json& part : build["parts"]) add_summary(begin, part["name"], "s", part["seconds"]);
        add_summary(begin, "share_of_bandwidth_bound", "1", build["share_of_bandwidth_bound"]);
    }

    void add_cast(const std::string& mesh, const Json& cast) {
        const std::string begin =
            fmt::format("\"{}\",cast,\"{}\",{},{},\"{}\"", mesh, cast["tree"].get<std::string>(),
                        cast["traversal"].get<std::string>(), cast["rays"].get<std::string>(),
                        cast["start"].get<std::string>());
        add_summary(begin, "cast", "s", cast["seconds"]);
        add_value(begin, "rays_per_s", "1/s", cast["rays_per_s"]);
        for (const char* number : {"boxes_a_ray", "triangles_a_ray", "restarts_a_ray"})
            add_value(begin, number, "1", cast[number]);
        add_value(begin, "bytes_a_ray", "bytes", cast["bytes_a_ray"]);
    }

    std::string text_;
};

/// Of a mesh, as part of a file name; the user's meshes by their place in the list.
std::string make_file_part(const Json& mesh, size_t place) {
    const std::string name = mesh["mesh"];
    for (const std::string& known : structure_scene_names())
        if (name == known) return name;
    return fmt::format("mesh{}", place);
}

} // namespace

std::vector<ReportFile> make_paper2_files(const Json& result) {
    std::vector<ReportFile> files = {{"paper2.json", result.dump(1) + "\n"},
                                     {"paper2.csv", CsvWriter().write(result)},
                                     {"paper2_builds.svg", make_bar_chart(make_build_chart(result))},
                                     {"paper2_bytes.svg", make_bar_chart(make_bytes_chart(result))}};
    for (size_t k = 0; k < result["meshes"].size(); ++k) {
        const Json& mesh = result["meshes"][k];
        for (const auto& [rays, count] : mesh["rays"].items())
            files.push_back({fmt::format("paper2_{}_{}.svg", make_file_part(mesh, k), rays),
                             make_bar_chart(make_cast_chart(result, mesh, rays))});
    }
    return files;
}

} // namespace relief::bench
