// Parts of scenes as dicts with the keys of the scene file.
#pragma once

#include <vector>

#include <nanobind/nanobind.h>

#include "relief/aim.h"
#include "relief/scene.h"

namespace relief::python {

nanobind::dict describe_camera(const Camera& camera);
/// All but its picture.
nanobind::dict describe_environment(const Environment& environment);
/// Of suns.
nanobind::list describe_suns(const std::vector<Light>& lights);
/// Base colour and roughness: of materials that the library made.
nanobind::dict describe_material(const Material& material);

/// Keywords of Scene.aim, named after the command's options.
AimOptions read_aim(const nanobind::dict& keywords);

} // namespace relief::python
