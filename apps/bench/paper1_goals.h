// Which of the project's goals a result tells about, and whether they are met.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace relief::bench {

/// A list of {name, goal, reached, unit, met} from the measures in `result`; goals of a GPU only for the
/// Vulkan engine. What was not measured is left out.
nlohmann::ordered_json make_paper1_goals(const nlohmann::ordered_json& result);

} // namespace relief::bench
