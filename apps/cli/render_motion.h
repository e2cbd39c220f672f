// Pictures of frames of a shot, with motion blur where the shutter of the camera is open.
#pragma once

#include "relief/render.h"
#include "relief/shot.h"
#include "render_options.h"

namespace relief::cli {

/// Whether pictures of what the shot has loaded are blurred by motion.
bool is_moving(const Shot& shot, const Camera& camera);

/// Throws Error{usage} for options that change such a scene at one time alone, or its surfaces.
void check_motion(const RenderOptions& options);

/// As render(), of a scene that the shot has loaded last, at a frame.
RenderResult render_shot(Shot& shot, int frame, Scene scene, const RenderSettings& settings,
                         RenderObserver* observer, const Checkpoints& checkpoints);

} // namespace relief::cli
