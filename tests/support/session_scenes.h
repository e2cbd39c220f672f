// What sessions are tested with: a rough torus, several bodies, and small pictures of them.
#pragma once

#include <cstddef>
#include <string>
#include <utility>

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

/// Two bodies, one of them a mirror image that glows, over a plain one, in light of an environment and a sun.
inline Scene make_session_scene() {
    Scene scene = make_rough_torus();
    Material glowing;
    glowing.emission = {0.5f, 0.4f, 0.3f}, glowing.coat_weight = 0.5f;
    scene.materials.push_back(glowing);
    Object second = scene.objects[0];
    second.material = uint32_t(scene.materials.size() - 1);
    second.world_from_object.rows[0] = second.world_from_object.rows[0] * -1.0f;
    second.world_from_object.translation = {0, 1.5f, 0};
    scene.objects.push_back(second);
    Object plain = scene.objects[0];
    plain.displacement = kNoIndex, plain.world_from_object.translation = {0, -1.5f, 0};
    scene.objects.push_back(plain);
    scene.lights.push_back({});
    scene.lights.back().direction = {-1, -2, -1};
    for (size_t k = 0; k < scene.meshes.size(); ++k) scene.meshes[k].name = "mesh " + std::to_string(k);
    return scene;
}

/// The scene without meshes, which are as they were.
inline SceneUpdate leave_out_meshes(Scene scene) {
    for (Mesh& mesh : scene.meshes) {
        Mesh empty;
        empty.name = mesh.name;
        mesh = std::move(empty);
    }
    const Camera camera = scene.camera;
    return {std::move(scene), camera, 7};
}

} // namespace relief::test
