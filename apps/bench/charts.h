// Charts of a result, drawn by a script beside the program.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace relief::bench {

struct DrawnCharts {
    std::vector<std::string> lines; ///< output of the script
    std::string failure; ///< why charts are missing, with the command that draws them; empty: success
};

/// Runs the script on the JSON file of a suite; charts are written beside it. A missing script or dependency
/// is reported in the result, not an error: the measurements are useful without charts.
DrawnCharts draw_charts(const std::filesystem::path& result);

} // namespace relief::bench
