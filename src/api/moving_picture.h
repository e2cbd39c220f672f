// The loop over the samples of a picture with motion blur: each sees the scene at its own time.
#pragma once

#include <functional>

#include "engine/engine.h"

namespace relief {

/// What a session does for the loop.
struct MovingStage {
    /// Puts the scene of a sample in place, counted from the first of all; the engine adds up to `image.spp`.
    std::function<void(int sample, const ImageSettings& image)> move;
    /// As Engine::render(), by the engine that there is then.
    std::function<bool(Film& film, const RenderControl& control)> render;
};

/// Adds those samples to a film that it lacks, one after another over the whole picture; time limits, noise,
/// progress and interruptions as in one render. Returns false when the observer cancelled.
bool render_samples(Film& film, const ImageSettings& image, const RenderControl& control,
                    const MovingStage& stage);

} // namespace relief
