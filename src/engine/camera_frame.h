// The scene's camera as the formulas of shared/camera.h take it.
#pragma once

#include "engine/prepared_scene.h"
#include "math/scalar.h"

namespace relief {

scalar::CameraFrame make_camera_frame(const PreparedScene& scene);

} // namespace relief
