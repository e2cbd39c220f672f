// What a result says about the worth of the structures, as ratios.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace relief::bench {

/// A list of {name, goal, reached, unit, met} from the meshes in `result`.
nlohmann::ordered_json make_paper2_goals(const nlohmann::ordered_json& result);

} // namespace relief::bench
