// Which of the project's goals a result of the suite peers tells about, and whether they are met.
#pragma once

#include "common/report.h"

#include <string>

namespace relief::bench {

/// A list of {name, scene, level, goal, bound, reached, ratio, unit, met}. `bound` is "at least" or "at
/// most", `ratio` what was reached over the goal, or its inverse where less is better: 1 and more is met. Of
/// levels 5 and auto, or of all where neither was measured. What was not measured is left out.
Value make_peers_goals(const Value& result);

/// The goals as a table in Markdown: a row a goal, a column a scene and level. What was missed is bold, its
/// ratio behind it.
std::string make_goal_table(const Value& goals);

} // namespace relief::bench
