// Whether the camera looks out of a displaced body from within, where all light has to come through its
// surface.
#pragma once

#include "prepare/prepared_scene.h"

namespace relief {

/// Where levels are automatic, false only where the camera's whole aperture lies outside all closed displaced
/// surfaces and outside the space between two walls of one. Winding numbers of the undisplaced surfaces
/// decide (Jacobson, Kavan and Sorkine-Hornung 2013): they are those of the displaced ones wherever the
/// camera lies outside the boxes of their patches; within one, it may be enclosed.
bool may_enclose_camera(const PreparedScene& scene);

} // namespace relief
