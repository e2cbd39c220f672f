#include "bench/charts.h"

#include <fmt/format.h>

#include "bench/child_process.h"
#include "relief/error.h"

namespace relief::bench {

DrawnCharts draw_charts(const std::filesystem::path& result) {
    const std::filesystem::path script =
        std::filesystem::read_symlink("/proc/self/exe").replace_filename("relief-plot-bench");
    DrawnCharts drawn;
    try {
        const ChildResult child = run_child({script.string(), result.string()});
        for (const LogLine& line : child.lines) drawn.lines.push_back(line.text);
        if (child.exit_code == 0) return drawn;
        drawn.failure =
            drawn.lines.empty() ? fmt::format("exit code {}", child.exit_code) : drawn.lines.back();
    } catch (const Error& error) {
        drawn.failure = error.message();
    }
    drawn.failure = fmt::format("no charts were drawn: {}; {} {} draws them", drawn.failure, script.string(),
                                result.string());
    drawn.lines.clear();
    return drawn;
}

} // namespace relief::bench
