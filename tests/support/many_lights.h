// A hall under a thousand lights of all kinds.
#pragma once

#include <cmath>
#include <random>

#include "math/affine.h"
#include "support/shading_scenes.h"

namespace relief {

/// Lights that have a place, above a square of half width `half`; each kind may have an extent.
inline std::vector<Light> make_many_lights(size_t count, float half, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<Light> lights(count);
    for (size_t k = 0; k < count; ++k) {
        Light& light = lights[k];
        constexpr LightType kinds[] = {LightType::point, LightType::spot, LightType::rectangle,
                                       LightType::disk};
        light.type = kinds[k % 4];
        const float x = unit(random), y = unit(random), z = unit(random);
        light.position = {half * (2 * x - 1), 0.5f + 3 * y * y, half * (2 * z - 1)};
        light.direction = {unit(random) - 0.5f, -unit(random), unit(random) - 0.5f};
        light.strength = 0.02f * std::exp2(6 * unit(random));
        light.color = {0.5f + 0.5f * unit(random), 0.6f, 1 - 0.5f * unit(random)};
        light.cone_degrees = 30 + 120 * unit(random);
        light.blend = unit(random);
        light.width = 0.1f + 0.3f * unit(random), light.height = 0.1f;
        const bool is_flat = light.type == LightType::rectangle || light.type == LightType::disk;
        light.radius = is_flat || k % 8 < 4 ? 0.05f + 0.1f * unit(random) : 0;
    }
    return lights;
}

/// A floor, a wall and a ball under the lights, and two emissive bodies beside them.
inline Scene make_hall(size_t light_count) {
    Scene scene;
    Material floor = make_matte(0.7f), ball = make_matte(0.9f), glow = make_matte(0.2f);
    floor.ior = 1.5f, floor.roughness = 0.4f;
    ball.metallic = 1, ball.roughness = 0.3f;
    glow.emission = {0.5f, 0.6f, 0.4f};
    add_object(scene, make_floor(12), floor);
    add_object(scene, make_quad_mesh({Vec3f{-12, 0, -6}, {12, 0, -6}, {12, 5, -6}, {-12, 5, -6}}),
               make_matte(0.5f));
    add_object(scene, make_sphere(8, SphereNormals::smooth), ball);
    scene.objects.back().world_from_object = make_translation({0, 0.8f, 0});
    for (const float side : {-1.0f, 1.0f}) {
        add_object(scene, make_sphere(3, SphereNormals::facets), glow);
        scene.objects.back().world_from_object =
            compose(make_translation({3 * side, 0.5f, 1}), make_scale({0.3f, 0.3f, 0.3f}));
    }
    scene.lights = make_many_lights(light_count, 10, 3);
    scene.camera.from = {0, 4, 10}, scene.camera.to = {0, 0.5f, 0};
    return scene;
}

} // namespace relief
