// Scenes, as the reader of scene files makes them.
#pragma once

#include <memory>

#include <nanobind/nanobind.h>

#include "relief/scene.h"
#include "relief/shot.h"

namespace relief::python {

/// What Python calls _relief.Scene.
struct ParsedScene {
    Scene scene;
    /// Of a scene that moves while its camera's shutter is open, loaded at `frame`; else null.
    std::unique_ptr<Shot> shot;
    double frame = 1;
};

} // namespace relief::python
