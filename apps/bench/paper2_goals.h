// Evaluates the goals of the structures, as ratios.
#pragma once

#include "common/report.h"

namespace relief::bench {

/// A list of {name, goal, reached, unit, met} from the meshes in `result`.
Value make_paper2_goals(const Value& result);

} // namespace relief::bench
