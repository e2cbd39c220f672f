// The file of `--stats`: its keys are a contract with scripts.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "relief/render.h"

namespace relief::cli {

/// All numbers of one render under their stable keys.
nlohmann::ordered_json make_statistics_json(const RenderResult& result, const RenderSettings& settings);

} // namespace relief::cli
