// How work is left when a render was cancelled.
#pragma once

#include <exception>
#include <functional>

#include "relief/progress.h"

namespace relief {

/// Thrown where much work would begin after the render was cancelled; ends in the engine, or where the scene
/// is prepared for it.
struct StopRequest : std::exception {
    const char* what() const noexcept override { return "render cancelled"; }
};

/// While it lives, parallel loops of this thread, and those inside their bodies, throw StopRequest before the
/// next range (base/parallel.cpp) once `is_asked_for` holds, which is called from any thread, also at once.
/// Empty: never. `progress` hears how far the work within is (find_progress); empty: nobody asks.
class StopScope {
  public:
    explicit StopScope(std::function<bool()> is_asked_for, ProgressFunction progress = {});
    ~StopScope();
    StopScope(const StopScope&) = delete;
    StopScope& operator=(const StopScope&) = delete;

    struct Work {
        std::function<bool()> is_asked_for;
        ProgressFunction progress;
    };

  private:
    Work work_;
    const Work* outer_;
};

/// Throws StopRequest where a parallel loop would: for long work between loops.
void stop_if_asked();

/// That of the innermost StopScope; empty: nobody asks.
ProgressFunction find_progress();

} // namespace relief
