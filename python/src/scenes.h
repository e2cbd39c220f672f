// Scenes, as the reader of scene files makes them.
#pragma once

#include <nanobind/nanobind.h>

#include "relief/scene.h"

namespace relief::python {

/// What Python calls _relief.Scene.
struct ParsedScene {
    Scene scene;
};

} // namespace relief::python
