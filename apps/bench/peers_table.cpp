#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/peers_goals.h"

namespace relief::bench {

namespace {

std::string get_column(const Value& goal) {
    return fmt::format("{}, {}", goal["scene"].get<std::string>(), goal["level"].get<std::string>());
}

/// In order of appearance.
template <class Get> std::vector<std::string> list_distinct(const Value& goals, Get get) {
    std::vector<std::string> names;
    for (const Value& goal : goals)
        if (const std::string name = get(goal); std::find(names.begin(), names.end(), name) == names.end())
            names.push_back(name);
    return names;
}

std::string format_cell(const Value& goal) {
    const std::string reached = fmt::format("{:.3g}", goal["reached"].get<double>());
    return goal["met"].get<bool>() ? reached
                                   : fmt::format("**{}** ({:.2g})", reached, goal["ratio"].get<double>());
}

std::string make_row(const Value& goals, const std::string& what, const std::vector<std::string>& columns) {
    std::string bound;
    std::vector<std::string> cells(columns.size());
    for (const Value& goal : goals) {
        if (goal["what"] != what) continue;
        bound = fmt::format("{} {:g} {}", goal["bound"].get<std::string>(), goal["goal"].get<double>(),
                            goal["unit"].get<std::string>());
        const auto column = std::find(columns.begin(), columns.end(), get_column(goal));
        cells[size_t(column - columns.begin())] = format_cell(goal);
    }
    return fmt::format("| {} | {} | {} |\n", what, bound, fmt::join(cells, " | "));
}

} // namespace

std::string make_goal_table(const Value& goals) {
    Value places = Value::list();
    std::string text;
    for (const Value& goal : goals) {
        if (!goal["scene"].get<std::string>().empty())
            places.push_back(goal);
        else
            text += fmt::format("{}: {} {}, goal {} {:g}\n\n", goal["what"].get<std::string>(),
                                format_cell(goal), goal["unit"].get<std::string>(),
                                goal["bound"].get<std::string>(), goal["goal"].get<double>());
    }
    if (places.empty()) return text;
    const std::vector<std::string> columns = list_distinct(places, get_column);
    text += fmt::format("| what | goal | {} |\n|---|---|", fmt::join(columns, " | "));
    for (size_t k = 0; k < columns.size(); ++k) text += "---|";
    text += "\n";
    for (const std::string& what :
         list_distinct(places, [](const Value& goal) { return goal["what"].get<std::string>(); }))
        text += make_row(places, what, columns);
    return text;
}

} // namespace relief::bench
