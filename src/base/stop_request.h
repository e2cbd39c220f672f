// How work is left when a render was cancelled.
#pragma once

#include <exception>
#include <functional>

namespace relief {

/// Thrown where much work would begin after the render was cancelled; ends in the engine, or where the scene
/// is prepared for it.
struct StopRequest : std::exception {
    const char* what() const noexcept override { return "render cancelled"; }
};

/// While it lives, parallel loops of this thread, and those inside their bodies, throw StopRequest before the
/// next range (base/parallel.cpp) once `is_asked_for` holds, which is called from any thread, also at once.
/// Empty: never.
class StopScope {
  public:
    explicit StopScope(std::function<bool()> is_asked_for);
    ~StopScope();
    StopScope(const StopScope&) = delete;
    StopScope& operator=(const StopScope&) = delete;

  private:
    std::function<bool()> is_asked_for_;
    const std::function<bool()>* outer_;
};

} // namespace relief
