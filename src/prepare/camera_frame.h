// The scene's camera as the formulas of formulas/camera.h take it.
#pragma once

#include "formulas/camera.h"
#include "prepare/prepared_scene.h"

namespace relief {

scalar::CameraFrame make_camera_frame(const PreparedScene& scene);

} // namespace relief
