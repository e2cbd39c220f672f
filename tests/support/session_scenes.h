// What sessions are tested with: a rough torus, and small pictures of it.
#pragma once

#include "relief/render.h"
#include "relief/scene.h"
#include "support/bodies.h"

namespace relief::test {

/// Its displacement is called "map".
inline Scene make_rough_torus(DisplacementSpace space = DisplacementSpace::tangent) {
    Scene scene =
        make_body_scene(make_torus(8, 16), make_displacement(make_random_map(96, 64, 0.05f, 3), space));
    scene.displacements[0].wrap = WrapMode::repeat;
    scene.camera.from = {2.4f, 1.9f, 1.2f}, scene.camera.to = {0, 0, 0};
    scene.environment = Environment{};
    return scene;
}

inline RenderSettings make_session_settings() {
    RenderSettings settings;
    settings.image.width = 96, settings.image.height = 72, settings.image.spp = 2, settings.image.bounces = 2;
    settings.image.layers = {"depth", "N", "id"};
    return settings;
}

} // namespace relief::test
