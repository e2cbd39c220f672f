// What Python gets of a render.
#pragma once

#include <nanobind/nanobind.h>

#include "relief/session.h"
#include "render_job.h"

namespace relief::python {

/// Image or None, statistics as JSON text, warnings, whether it is complete, samples of every pixel,
/// exception or None.
nanobind::object make_answer(JobReport&& report, const RenderSettings& settings);

/// Renders a prepared scene with the settings that it has; the answer is that of make_answer.
nanobind::object render_session(Session& session, const RenderSettings& settings, RenderCallbacks callbacks);

} // namespace relief::python
