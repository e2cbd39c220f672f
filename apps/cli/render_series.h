// Several pictures of one command: turntables, edits and frames.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "finish_picture.h"
#include "relief/scene.h"
#include "relief/shot.h"

namespace relief::cli {

/// The pictures of a turntable, one after the other, of a scene that stays prepared.
int render_turns(const RenderOptions& options, const RenderSettings& settings, Scene scene,
                 PendingTimes waiting);

/// The scene of a frame, ready to be rendered, and the settings of its picture.
using LoadFrame = std::function<std::pair<Scene, RenderSettings>(int frame)>;

/// One picture a frame. Where only the camera differs from the frame before, the scene stays prepared.
int render_frames(const RenderOptions& options, Shot& shot, const std::vector<int>& frames,
                  const LoadFrame& load, PendingTimes waiting);

/// The first picture, then one after each edit with an output.
int render_edits(const RenderOptions& options, const RenderSettings& settings, Scene scene,
                 PendingTimes waiting);

} // namespace relief::cli
