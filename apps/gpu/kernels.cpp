#include "gpu/kernels.h"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "relief/error.h"

namespace relief::gpu {

namespace {

using vulkan::KernelFigure;
using vulkan::KernelProgram;

/// One key for what drivers call by different names.
struct CommonFigure {
    const char *key, *heading;
    std::vector<const char*> names; ///< of RADV, NVIDIA, Intel; whatever the case of letters
};

const std::vector<CommonFigure>& get_common_figures() {
    static const std::vector<CommonFigure> figures = {
        {"registers", "registers", {"VGPRs", "Register Count"}},
        {"scalar_registers", "scalar", {"SGPRs"}},
        {"spills", "spills", {"Spilled VGPRs", "Spill Count"}},
        {"scalar_spills", "scalar spills", {"Spilled SGPRs"}},
        {"scratch_bytes",
         "scratch",
         {"Scratch size", "Local Memory", "Local Memory Size", "Scratch Memory Size"}},
        {"stack_bytes", "stack", {"Stack Size"}},
        {"shared_bytes", "shared", {"LDS size", "Shared Memory", "Shared Memory Size"}},
        {"waves", "waves", {"Subgroups per SIMD", "Occupancy"}},
        {"instructions", "instructions", {"Instructions", "Instruction Count"}},
        {"code_bytes", "code", {"Code size", "Binary Size"}},
        {"latency", "latency", {"Latency", "Cycle Count"}},
    };
    return figures;
}

bool is_same_name(std::string_view a, std::string_view b) {
    return std::ranges::equal(
        a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

const KernelFigure* find_figure(const KernelProgram& program, const CommonFigure& common) {
    for (const KernelFigure& figure : program.figures)
        for (const char* name : common.names)
            if (is_same_name(figure.name, name)) return &figure;
    return nullptr;
}

Value make_value(const KernelFigure& figure) {
    return std::visit([](auto value) { return Value(value); }, figure.value);
}

/// Of an invocation, where the driver tells what a subgroup has.
Value make_common_value(const KernelProgram& program, const KernelFigure& figure) {
    const uint64_t* value = std::get_if<uint64_t>(&figure.value);
    const bool is_of_subgroup = value && is_same_name(figure.name, "Scratch size") &&
                                figure.description.find("per subgroup") != std::string::npos;
    if (is_of_subgroup && program.subgroup_size > 0) return *value / program.subgroup_size;
    // NVIDIA's driver 580 sets a bit above the 32 of the figure.
    if (value && is_same_name(figure.name, "Local Memory Size")) return *value & 0xffffffffu;
    return make_value(figure);
}

/// Without those that are 0, or kNoIndex: switched off.
Value describe_constants(const std::vector<uint32_t>& constants,
                         const std::map<uint32_t, std::string>& names) {
    Value result = Value::record();
    for (uint32_t k = 0; k < constants.size(); ++k) {
        if (constants[k] == 0 || constants[k] == kNoIndex) continue;
        const auto name = names.find(k);
        result[name == names.end() ? std::to_string(k) : name->second] = constants[k];
    }
    return result;
}

Value describe_program(const KernelReport& report, const ReportedKernel& kernel,
                       const KernelProgram& program) {
    Value row = {{"kernel", kernel.statistics.shader}};
    if (!kernel.statistics.vertex_shader.empty()) row["vertex_shader"] = kernel.statistics.vertex_shader;
    row["program"] = program.name;
    row["cases"] = Value(kernel.cases);
    row["constants"] = describe_constants(kernel.statistics.constants, report.constant_names);
    row["subgroup_size"] = program.subgroup_size;
    for (const CommonFigure& common : get_common_figures())
        if (const KernelFigure* figure = find_figure(program, common))
            row[common.key] = make_common_value(program, *figure);
    row["reported"] = Value::record();
    for (const KernelFigure& figure : program.figures) row["reported"][figure.name] = make_value(figure);
    return row;
}

/// The first case of a row, and how many more there are.
std::string describe_cases(const Value& row) {
    const Value& cases = row["cases"];
    const std::string first = cases[0].get<std::string>();
    return cases.size() == 1 ? first : fmt::format("{} +{}", first, cases.size() - 1);
}

/// Of a drawn kernel also the stage.
std::string describe_name(const Value& row) {
    const std::string name = row["kernel"].get<std::string>();
    if (!row.contains("vertex_shader")) return name;
    return fmt::format("{} ({})", name, row["program"].get<std::string>());
}

} // namespace

Value describe_kernels(const KernelReport& report) {
    Value cases = Value::record(), figures = Value::record(), kernels = Value::list();
    for (const KernelCase& each : report.cases) cases[each.name] = each.meaning;
    for (const ReportedKernel& kernel : report.kernels)
        for (const KernelProgram& program : kernel.statistics.programs) {
            for (const KernelFigure& figure : program.figures) figures[figure.name] = figure.description;
            kernels.push_back(describe_program(report, kernel, program));
        }
    return {{"device", report.device},
            {"driver", report.driver},
            {"cases", std::move(cases)},
            {"figures", std::move(figures)},
            {"kernels", std::move(kernels)}};
}

Value list_kernels(const RenderSettings& settings, const std::function<void(const std::string&)>& on_case) {
#ifdef RELIEF_VULKAN
    return describe_kernels(report_kernels(settings, on_case));
#else
    static_cast<void>(settings), static_cast<void>(on_case);
    throw Error(ErrorKind::device_missing,
                {"this build has no Vulkan", "kernels", "configure it with -DRELIEF_VULKAN=ON"});
#endif
}

std::string print_kernels(const Value& list) {
    std::vector<std::vector<std::string>> lines = {{"kernel", "case"}};
    std::vector<const CommonFigure*> columns;
    for (const CommonFigure& common : get_common_figures())
        if (std::ranges::any_of(list["kernels"], [&](const Value& row) { return row.contains(common.key); }))
            columns.push_back(&common), lines[0].push_back(common.heading);
    for (const Value& row : list["kernels"]) {
        lines.push_back({describe_name(row), describe_cases(row)});
        for (const CommonFigure* column : columns)
            lines.back().push_back(
                row.contains(column->key) ? fmt::format("{}", row[column->key].get<uint64_t>()) : "-");
    }
    std::vector<size_t> widths(lines[0].size(), 0);
    for (const auto& line : lines)
        for (size_t k = 0; k < line.size(); ++k) widths[k] = std::max(widths[k], line[k].size());
    std::string text =
        fmt::format("{}, {}\n", list["device"].get<std::string>(), list["driver"].get<std::string>());
    for (const auto& line : lines) {
        text += fmt::format("{:<{}}  {:<{}}", line[0], widths[0], line[1], widths[1]);
        for (size_t k = 2; k < line.size(); ++k) text += fmt::format("  {:>{}}", line[k], widths[k]);
        text += '\n';
    }
    return text;
}

} // namespace relief::gpu
