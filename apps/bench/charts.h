// Charts of a result, drawn by the script that lies beside the program.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace relief::bench {

struct DrawnCharts {
    std::vector<std::string> lines; ///< what the script said
    std::string failure; ///< why there are none, with the command that draws them; empty: there are
};

/// Runs the script over the JSON file of a suite; the charts lie beside it. Where the script or what it needs
/// is missing, that is told in the result: measurements are worth keeping without.
DrawnCharts draw_charts(const std::filesystem::path& result);

} // namespace relief::bench
