// How an engine leaves its work when a render was cancelled.
#pragma once

#include <exception>

namespace relief {

/// Thrown where much work would begin after the render was cancelled; ends in the engine.
struct StopRequest : std::exception {
    const char* what() const noexcept override { return "render cancelled"; }
};

} // namespace relief
