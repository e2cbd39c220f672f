// The sums that a render hands over to be saved.
#pragma once

#include <functional>
#include <ostream>
#include <sstream>
#include <string>

#include "relief/render.h"

namespace relief::test {

/// Renders the scene; returns what it saved last.
inline std::string render_film(const Scene& scene, const RenderSettings& settings) {
    std::string bytes;
    Checkpoints checkpoints;
    checkpoints.save = [&](const std::function<void(std::ostream&)>& write) {
        std::ostringstream stream;
        write(stream);
        bytes = stream.str();
    };
    render(scene, settings, nullptr, checkpoints);
    return bytes;
}

} // namespace relief::test
