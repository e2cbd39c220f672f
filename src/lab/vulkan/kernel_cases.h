// Small scenes and settings that together need every kernel with every constant.
#pragma once

#include <string>
#include <vector>

#include "relief/render.h"
#include "relief/scene.h"

namespace relief {

struct SceneCase {
    std::string name, meaning;
    Scene scene;
    RenderSettings settings;
};

/// The first is the plainest: a displaced surface under one light. Each of the others differs from it in one
/// thing, but for the last, which has all of them.
std::vector<SceneCase> make_scene_cases(const RenderSettings& settings);

/// Of the plainest scene, with the engine's other ways to traverse trees.
std::vector<SceneCase> make_walk_cases(const RenderSettings& settings);

} // namespace relief
