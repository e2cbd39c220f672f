// Evaluates the project's goals for a result of the suite peers.
#pragma once

#include "common/report.h"

#include <string>

namespace relief::bench {

/// A list of {name, scene, level, goal, bound, reached, ratio, unit, met}. `bound` is "at least" or "at
/// most", `ratio` is reached / goal, or its inverse where less is better: met from 1 on. For levels 5 and
/// auto, or for all if neither was measured. Goals without measurements are left out.
Value make_peers_goals(const Value& result);

/// The goals as a Markdown table: one row per goal, one column per scene and level. Missed goals are bold,
/// followed by their ratio.
std::string make_goal_table(const Value& goals);

} // namespace relief::bench
