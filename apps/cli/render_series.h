// Several pictures of one command: turntables and edits.
#pragma once

#include "finish_picture.h"
#include "relief/scene.h"

namespace relief::cli {

/// The pictures of a turntable, one after the other, of a scene that stays prepared.
int render_turns(const RenderOptions& options, const RenderSettings& settings, Scene scene,
                 PendingTimes waiting);

/// The first picture, then one after each edit with an output.
int render_edits(const RenderOptions& options, const RenderSettings& settings, Scene scene,
                 PendingTimes waiting);

} // namespace relief::cli
