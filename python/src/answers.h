// What Python gets of a render.
#pragma once

#include <nanobind/nanobind.h>

#include "render_job.h"

namespace relief::python {

/// Image or None, statistics as JSON text, warnings, whether it is complete, samples of every pixel,
/// exception or None.
nanobind::object make_answer(JobReport&& report, const RenderSettings& settings);

} // namespace relief::python
