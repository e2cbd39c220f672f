// Which levels bounce rays see, for both engines.
#pragma once

#include "formulas/bounce_lod.h"
#include "prepare/prepared_scene.h"

namespace relief {

/// Off, with a cell_angle of 0, where no surface has automatic levels, the camera may look out of a displaced
/// body, or the settings say so.
scalar::BounceLod make_bounce_lod(const PreparedScene& scene, const RenderSettings& settings);

} // namespace relief
