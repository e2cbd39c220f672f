// Which of the project's goals a result tells about, and whether they are met.
#pragma once

#include "common/report.h"

namespace relief::bench {

/// A list of {name, goal, reached, unit, met} from the measures in `result`; goals of a GPU only for the
/// Vulkan engine. What was not measured is left out.
Value make_paper1_goals(const Value& result);

} // namespace relief::bench
