// The file of `--stats`; its keys are stable, scripts depend on them.
#pragma once

#include "common/report.h"
#include "relief/render.h"

namespace relief::cli {

/// All statistics of one render under their stable keys.
Value describe_statistics(const RenderResult& result, const RenderSettings& settings);

/// False where a render was cancelled or its time limit left samples out. Pixels whose noise is low enough
/// lack none.
bool has_all_samples(const RenderResult& result);

} // namespace relief::cli
