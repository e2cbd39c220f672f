#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bench/frame.h"

namespace relief::bench {

namespace {

using Cells = std::vector<Value>;

constexpr const char* kPrograms[] = {"relief", "baseline"};

bool is_told(const Value& value) { return value.kind() != Value::Kind::nothing; }

/// Null where an entry lacks it, as `share` of a stage without any time does.
Value find_entry(const Value& record, const std::string& name) {
    return record.contains(name) ? record[name] : Value();
}

void add_summary(Table& table, Cells cells, const std::string& measure, const Value& summary) {
    cells.emplace_back(measure);
    for (const char* part : {"median", "lower_quartile", "upper_quartile", "lowest", "highest"})
        cells.push_back(is_told(summary) ? summary[part] : Value());
    table.rows.push_back(std::move(cells));
}

void add_number(Table& table, Cells cells, const std::string& measure, const Value& number) {
    cells.insert(cells.end(), {measure, number, {}, {}, {}, {}});
    table.rows.push_back(std::move(cells));
}

void add_program(Table& table, const Cells& cells, const Value& program) {
    for (const char* measure : {"samples_per_s", "rays_per_sample", "render_s", "prepare_s", "first_image_s",
                                "processor_s", "peak_resident_bytes"})
        add_summary(table, cells, measure, program[measure]);
    for (const auto& [stage, told] : program["stages"].members()) {
        add_summary(table, cells, stage + "_s", told["seconds"]);
        add_number(table, cells, stage + "_share", find_entry(told, "share"));
    }
}

template <class Format> std::string format_cell(const Value& value, Format format) {
    return is_told(value) ? format(value) : "-";
}

std::string format_spread(const Value& summary, double unit) {
    return format_cell(summary, [&](const Value& s) {
        const auto get = [&](const char* part) { return s[part].get<double>() / unit; };
        return fmt::format("{:.3g} ({:.3g} to {:.3g})", get("median"), get("lower_quartile"),
                           get("upper_quartile"));
    });
}

std::string format_median(const Value& summary) {
    return format_cell(summary,
                       [](const Value& s) { return fmt::format("{:.3g}", s["median"].get<double>()); });
}

std::string format_difference(const Value& pictures) {
    const std::string brightness =
        format_cell(pictures["brightness_difference"], [](const Value& difference) {
            return fmt::format("{:+.3f} %", 100 * difference.get<double>());
        });
    return fmt::format("{}, {:.3g}", brightness, pictures["relative_squared_error"].get<double>());
}

std::string make_row(const std::vector<std::string>& cells) {
    return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

std::string make_header(const std::vector<std::string>& columns) {
    std::string rule = "|";
    for (size_t k = 0; k < columns.size(); ++k) rule += "---|";
    return make_row(columns) + rule + "\n";
}

std::vector<std::string> list_place(const Value& entry) {
    return {entry["scene"].get<std::string>(),
            format_cell(entry["isa"], [](const Value& isa) { return isa.get<std::string>(); })};
}

std::string make_speed_table(const Value& result) {
    const bool has_baseline = result.contains("baseline");
    std::vector<std::string> columns = {"scene", "isa", "samples a second, millions", "rays a sample",
                                        "prepare, s"};
    if (has_baseline)
        columns = {"scene",           "isa",           "samples a second, millions",
                   "of the baseline", "ratio",         "with preparation",
                   "by processor",    "rays a sample", "baseline's",
                   "prepare, s",      "baseline's",    "brightness, squared error",
                   "noise alone"};
    std::string text = make_header(columns);
    for (const Value& entry : result["cases"]) {
        std::vector<std::string> cells = list_place(entry);
        cells.push_back(format_spread(entry["relief"]["samples_per_s"], 1e6));
        if (has_baseline) {
            cells.push_back(format_spread(entry["baseline"]["samples_per_s"], 1e6));
            for (const char* ratio : {"ratio", "ratio_with_preparation", "ratio_by_processor"})
                cells.push_back(format_spread(entry[ratio], 1));
        }
        for (const char* measure : {"rays_per_sample", "prepare_s"})
            for (const char* program : kPrograms)
                if (entry.contains(program)) cells.push_back(format_median(entry[program][measure]));
        if (has_baseline)
            cells.insert(cells.end(),
                         {format_difference(entry["picture"]), format_difference(entry["noise"])});
        text += make_row(cells);
    }
    return text;
}

/// Those that any program tells, in order of appearance.
std::vector<std::string> list_stages(const Value& result) {
    std::vector<std::string> stages;
    for (const Value& entry : result["cases"])
        for (const char* program : kPrograms)
            if (entry.contains(program))
                for (const Member& stage : entry[program]["stages"].members())
                    if (std::ranges::find(stages, stage.name) == stages.end()) stages.push_back(stage.name);
    return stages;
}

std::string format_stage(const Value& stages, const std::string& name) {
    return format_cell(find_entry(stages, name), [](const Value& stage) {
        const std::string share = format_cell(find_entry(stage, "share"), [](const Value& part) {
            return fmt::format("{:.1f} %", 100 * part.get<double>());
        });
        return fmt::format("{} ({:.3g} s)", share, stage["seconds"]["median"].get<double>());
    });
}

std::string make_stage_table(const Value& result) {
    const std::vector<std::string> stages = list_stages(result);
    std::vector<std::string> columns = {"scene", "isa", "program"};
    columns.insert(columns.end(), stages.begin(), stages.end());
    std::string text = make_header(columns);
    for (const Value& entry : result["cases"])
        for (const char* program : kPrograms) {
            if (!entry.contains(program)) continue;
            std::vector<std::string> cells = list_place(entry);
            cells.emplace_back(program);
            for (const std::string& stage : stages)
                cells.push_back(format_stage(entry[program]["stages"], stage));
            text += make_row(cells);
        }
    return text;
}

} // namespace

Table make_frame_table(const Value& result) {
    Table table{{"scene", "isa", "program", "measure", "median", "lower_quartile", "upper_quartile", "lowest",
                 "highest"},
                {}};
    for (const Value& entry : result["cases"]) {
        for (const char* program : kPrograms)
            if (entry.contains(program))
                add_program(table, {entry["scene"], entry["isa"], program}, entry[program]);
        const Cells both = {entry["scene"], entry["isa"], {}};
        for (const char* ratio : {"ratio", "ratio_with_preparation", "ratio_by_processor"})
            if (entry.contains(ratio)) add_summary(table, both, ratio, entry[ratio]);
        for (const char* pictures : {"picture", "noise"})
            if (entry.contains(pictures))
                for (const auto& [measure, number] : entry[pictures].members())
                    add_number(table, both, fmt::format("{}_{}", pictures, measure), number);
    }
    return table;
}

std::string make_frame_page(const Value& result) {
    return "Medians, in brackets the quartiles.\n\n" + make_speed_table(result) + "\n" +
           make_stage_table(result);
}

} // namespace relief::bench
