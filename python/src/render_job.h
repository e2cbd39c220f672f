// A render on a thread of its own, while the thread that asked for it waits: it alone runs Python code, for
// callbacks and signals.
#pragma once

#include <functional>

#include <nanobind/nanobind.h>

#include "relief/render.h"

namespace relief::python {

/// How far a render or a preparation is.
struct JobProgress : Progress {
    double prepared = 1; ///< [0, 1] of the faces of meshes; there are rays once all are
};

struct RenderCallbacks {
    /// Called with a JobProgress, several times a second from the start on; returning False stops the work.
    /// May be None.
    nanobind::object on_progress;
    nanobind::object on_picture; ///< called with an Image; the same
    double picture_interval_s = 0.5;
    int samples_total = 0; ///< while there are no rays yet
};

struct JobReport {
    RenderResult result;
    nanobind::object failure; ///< exception of a callback or signal that stopped the render, or None
};

/// Calls `work` with an observer, without the GIL. The first KeyboardInterrupt stops the render, and is a
/// failure only where there is no picture then. Errors of `work` are thrown, unless a callback has failed.
JobReport run_job(const std::function<RenderResult(RenderObserver&)>& work, const RenderCallbacks& callbacks);

/// The same for work without a picture; the exception of a callback or signal is thrown.
void run_step(const std::function<void(RenderObserver&)>& work, const nanobind::object& on_progress,
              int samples_total);

} // namespace relief::python
