// A render on a thread of its own, while the thread that asked for it waits: it alone runs Python code, for
// callbacks and signals.
#pragma once

#include <functional>

#include <nanobind/nanobind.h>

#include "relief/render.h"

namespace relief::python {

struct RenderCallbacks {
    /// Called with a Progress, several times a second from the start on; returning False stops the render.
    /// May be None.
    nanobind::object on_progress;
    nanobind::object on_picture; ///< called with an Image; the same
    double picture_interval_s = 0.5;
    Progress at_start{}; ///< while there are no rays yet
};

struct JobReport {
    RenderResult result;
    nanobind::object failure; ///< exception of a callback or signal that stopped the render, or None
};

/// Calls `work` with an observer, without the GIL. The first KeyboardInterrupt stops the render, and is a
/// failure only where there is no picture then. Errors of `work` are thrown.
JobReport run_job(const std::function<RenderResult(RenderObserver&)>& work, const RenderCallbacks& callbacks);

} // namespace relief::python
