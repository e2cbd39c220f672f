// Stacked bar charts as SVG: panels side by side. Each has a linear axis of its own, or all share a
// logarithmic one.
#pragma once

#include <string>
#include <vector>

namespace relief::bench {

enum class Unit { milliseconds, bytes };
enum class Scale { linear, logarithmic };

struct Bar {
    std::string label;
    std::vector<double> values; ///< one a series of the chart, stacked; with a logarithmic scale one is not 0
    std::string note;           ///< written in place of the bar, e.g. why there is none
    double lowest = 0, highest = 0; ///< spread of the sum, drawn as a whisker; both 0: none known
};

struct Panel {
    std::string title;
    std::string subtitle; ///< may be empty
    std::vector<Bar> bars;
};

struct Chart {
    std::string title;
    std::string axis; ///< what the height of a bar is
    Unit unit = Unit::milliseconds;
    Scale scale = Scale::linear;
    std::vector<std::string> series; ///< at most 8
    std::vector<Panel> panels;
    std::vector<std::string> notes; ///< below the chart, a line each
};

/// The chart as an SVG document. No panels: title and notes alone.
std::string make_bar_chart(const Chart& chart);

/// 1234 milliseconds as "1.23 s", 52e9 bytes as "52 GB" (decimal, as the papers count).
std::string format_value(Unit unit, double value);

} // namespace relief::bench
