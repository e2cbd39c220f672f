#include "bench/tables.h"

#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace relief::bench {

namespace {

using Cells = std::vector<Value>;

/// Adds `cells` and fills up the row.
void add_row(Table& table, Cells cells, std::initializer_list<Value> rest) {
    cells.insert(cells.end(), rest.begin(), rest.end());
    table.rows.push_back(std::move(cells));
}

void add_summary(Table& table, const Cells& cells, const std::string& measure, const Value& unit,
                 const Value& summary) {
    add_row(table, cells, {measure, unit, summary["median"], summary["lowest"], summary["highest"]});
}

/// A single number without spread.
void add_number(Table& table, const Cells& cells, const std::string& measure, const char* unit,
                const Value& number) {
    add_row(table, cells, {measure, unit, number, {}, {}});
}

void add_stages(Table& table, const Cells& cells, const Value& stages) {
    for (const auto& [stage, summary] : stages.members()) add_summary(table, cells, stage, "s", summary);
}

void add_memory_row(Table& table, const Value& row) {
    const auto add = [&](const std::string& variant, const Value& bytes) {
        add_number(table, {"table1_1", row["scene"], variant, {}, {}}, "total", "bytes", bytes);
    };
    add("direct", row["direct"]["total_bytes"]);
    add("paper, direct", row["paper"]["direct_bytes"]);
    for (const Value& cost : row["tessellated_estimate"])
        add("tessellated, level " + cost["level"].get<std::string>(), cost["total_bytes"]);
    add("paper, tessellated", row["paper"]["tessellated_bytes"]);
}

void add_frames(Table& table, const char* part, const Value& scene) {
    for (const Value& variant : scene["variants"]) {
        if (!variant.contains("frame_s")) continue; // rejected
        const Cells cells = {part, scene["scene"], variant["name"], {}, {}};
        add_summary(table, cells, "frame", "s", variant["frame_s"]);
        add_summary(table, cells, "prepare", "s", variant["prepare_s"]);
        add_stages(table, cells, variant["stage_s"]);
    }
}

void add_casts(Table& table, const char* figure, const Value& scene) {
    for (const Value& variant : scene["variants"])
        for (const Value& cast : variant["casts"]) {
            const Cells cells = {figure, scene["scene"], variant["name"], cast["depth"], cast["kind"]};
            add_stages(table, cells, cast["stage_s"]);
            add_summary(table, cells, "total", "s", cast["total_s"]);
        }
}

void add_tree_build(Table& table, const std::string& mesh, const Value& build) {
    const Cells cells = {mesh, "build", build["tree"], {}, {}, {}};
    add_summary(table, cells, "build", "s", build["seconds"]);
    for (const char* bytes : {"bytes", "link_bytes", "bytes_a_triangle"})
        add_number(table, cells, bytes, "bytes", build[bytes]);
    for (const char* number : {"slots", "used_slots", "used_share", "entries_a_triangle", "depth"})
        add_number(table, cells, number, "1", build[number]);
    if (!build.contains("parts")) return;
    for (const Value& part : build["parts"])
        add_summary(table, cells, part["name"].get<std::string>(), "s", part["seconds"]);
    add_summary(table, cells, "share_of_bandwidth_bound", "1", build["share_of_bandwidth_bound"]);
}

void add_tree_cast(Table& table, const std::string& mesh, const Value& cast) {
    const Cells cells = {mesh, "cast", cast["tree"], cast["traversal"], cast["rays"], cast["start"]};
    add_summary(table, cells, "cast", "s", cast["seconds"]);
    add_number(table, cells, "rays_per_s", "1/s", cast["rays_per_s"]);
    for (const char* number : {"boxes_a_ray", "triangles_a_ray", "restarts_a_ray"})
        add_number(table, cells, number, "1", cast[number]);
    add_number(table, cells, "bytes_a_ray", "bytes", cast["bytes_a_ray"]);
}

/// Unit from the name of the measure.
void add_named(Table& table, const Cells& cells, const std::string& measure, const Value& summary) {
    add_row(table, cells, {measure, summary["median"], summary["lowest"], summary["highest"]});
}

} // namespace

Table make_paper1_table(const Value& result) {
    Table table{
        {"part", "scene", "variant", "depth", "kind", "measure", "unit", "median", "lowest", "highest"}, {}};
    for (const Value& row : result["table1_1"]) add_memory_row(table, row);
    for (const char* part : {"figure1_7", "bottom_forms"})
        if (result.contains(part))
            for (const Value& scene : result[part]) add_frames(table, part, scene);
    for (const char* figure : {"figure1_9", "figure1_10"})
        for (const Value& scene : result[figure]) add_casts(table, figure, scene);
    return table;
}

Table make_paper2_table(const Value& result) {
    Table table{{"mesh", "part", "tree", "traversal", "rays", "start", "measure", "unit", "median", "lowest",
                 "highest"},
                {}};
    for (const Value& mesh : result["meshes"]) {
        const std::string name = mesh["mesh"].get<std::string>();
        for (const Value& build : mesh["builds"]) add_tree_build(table, name, build);
        for (const Value& cast : mesh["casts"]) add_tree_cast(table, name, cast);
    }
    return table;
}

Table make_paper3_table(const Value& result) {
    Table table{
        {"scene", "structure", "traversal", "method", "measure", "unit", "median", "lowest", "highest"}, {}};
    for (const Value& scene : result["scenes"])
        for (const Value& way : scene["ways"]) {
            if (!(way["outcome"] == "measured")) continue;
            const Cells cells = {scene["scene"], way["structure"], way["traversal"], way["method"]};
            add_summary(table, cells, "frame", "s", way["frame_s"]);
            add_summary(table, cells, "prepare", "s", way["prepare_s"]);
            add_stages(table, cells, way["stage_s"]);
            for (const char* bytes : {"geometry_bytes", "structures_bytes", "ray_buffers_bytes"})
                add_number(table, cells, bytes, "bytes", way[bytes]);
        }
    return table;
}

Table make_cycles_table(const Value& result) {
    Table table{{"scene", "samples", "bounces", "importance_map", "program", "measure", "median", "lowest",
                 "highest"},
                {}};
    for (const Value& scene : result["scenes"])
        for (const Value& entry : scene["cases"])
            for (const char* side : {"cycles", "relief"})
                for (const auto& [measure, summary] : entry[side].members())
                    add_named(
                        table,
                        {scene["scene"], entry["samples"], entry["bounces"], entry["importance_map"], side},
                        measure, summary);
    return table;
}

Table make_quality_table(const Value& result) {
    Table table{{"scene", "program", "denoised", "samples", "seconds", "error"}, {}};
    for (const Value& scene : result["scenes"])
        for (const Value& series : scene["series"])
            for (const Value& point : series["points"])
                table.rows.push_back({scene["scene"], series["program"],
                                      series["denoised"].get<bool>() ? "yes" : "no", point["samples"],
                                      point["seconds"], point["error"]});
    return table;
}

Table make_edits_table(const Value& result) {
    Table table{{"picture", "fresh_load_s", "fresh_prepare_s", "fresh_render_s", "fresh_picture_s", "edit_s",
                 "edit_picture_s", "slowest_edit_picture_s", "rays_share", "ratio", "ratio_of_slowest"},
                {}};
    for (const Value& entry : result["pictures"]) {
        const Value &fresh = entry["fresh"], &edits = entry["edits"];
        table.rows.push_back({entry["name"], fresh["load_s"]["median"], fresh["prepare_s"]["median"],
                              fresh["render_s"]["median"], fresh["picture_s"]["median"],
                              edits["edit_s"]["median"], edits["picture_s"]["median"],
                              edits["picture_s"]["highest"], edits["rays_share"]["median"], entry["ratio"],
                              entry["ratio_of_slowest"]});
    }
    return table;
}

Table make_triangles_table(const Value& result) {
    Table table{{"mesh", "triangles", "part", "count", "embree_s", "embree_robust_s", "relief_single_s",
                 "relief_packets_s", "ratio", "differences"},
                {}};
    for (const Value& mesh : result["meshes"]) {
        const Value& build = mesh["build"];
        table.rows.push_back({mesh["name"],
                              mesh["triangles"],
                              "build",
                              {},
                              build["embree_s"]["median"],
                              {},
                              build["relief_s"]["median"],
                              {},
                              build["ratio"],
                              {}});
        for (const Value& cast : mesh["casts"])
            table.rows.push_back({mesh["name"], mesh["triangles"], cast["rays"], cast["count"],
                                  cast["embree_s"]["median"], cast["embree_robust_s"]["median"],
                                  cast["relief_single_s"]["median"], cast["relief_packets_s"]["median"],
                                  cast["ratio"], cast["differences_from_embree"]});
    }
    return table;
}

Table make_peers_table(const Value& result) {
    Table table{{"scene", "level", "part", "rays", "program", "way", "call", "threads", "isa", "measure",
                 "median", "lowest", "highest"},
                {}};
    const Value& threads = result["settings"]["threads"];
    for (const Value& scene : result["scenes"]) {
        const Value &name = scene["scene"], &level = scene["level"];
        for (const auto& [way, cold] : scene["cold"].members())
            for (const auto& [measure, summary] : cold.members())
                add_named(
                    table,
                    {name, level, "cold", {}, way == "relief" ? "relief" : "embree", way, {}, threads, {}},
                    measure, summary);
        for (const Value& cast : scene["casts"])
            for (const Value& way : cast["ways"])
                add_named(table,
                          {name, level, "cast", cast["rays"], way["program"], way["way"],
                           way.text_or_empty("call"), way["threads"], way.text_or_empty("isa")},
                          "seconds", way["seconds"]);
        for (const Value& bounce : scene["bounces"])
            add_named(table,
                      {name,
                       level,
                       "path",
                       fmt::format("bounce {}", bounce["depth"].get<int>()),
                       "relief",
                       "path",
                       {},
                       threads,
                       {}},
                      "thread_seconds", bounce["total_s"]);
    }
    return table;
}

} // namespace relief::bench
