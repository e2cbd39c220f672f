// Scenes, as the reader of scene files makes them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <nanobind/nanobind.h>

#include "relief/io.h"
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

/// `meshes`: arrays by name; `textures`: arrays, or SharedTexture, by name.
SceneAssets read_assets(const nanobind::dict& meshes, const nanobind::dict& textures);

/// What speaks against what was said or assumed of the maps of a scene.
std::vector<std::string> find_doubts(const Scene& scene);

} // namespace relief::python
