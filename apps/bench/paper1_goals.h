// Evaluates the project's goals for a result.
#pragma once

#include "common/report.h"

namespace relief::bench {

/// A list of {name, goal, reached, unit, met} from the measures in `result`; GPU goals only for the Vulkan
/// engine. Goals without measurements are left out.
Value make_paper1_goals(const Value& result);

} // namespace relief::bench
