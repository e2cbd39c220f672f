// A scene of several instances, rays into it, and what the CPU engine finds.
#pragma once

#include <memory>
#include <random>
#include <vector>

#include "cpu/tracer.h"
#include "lab/scene_walks.h"
#include "math/affine.h"
#include "support/bodies.h"

namespace relief::test {

/// Nearest hits, and whether there is one.
struct CpuAnswers {
    std::vector<cpu::TraceHit> closest;
    std::vector<uint8_t> occluded;
};

inline CpuAnswers cast_on_cpu(const std::shared_ptr<const PreparedScene>& scene,
                              const RenderSettings& settings, const std::vector<cpu::TraceRay>& rays) {
    CpuAnswers answers;
    answers.closest.resize(rays.size());
    answers.occluded.resize(rays.size());
    const cpu::Tracer tracer(scene, settings, make_scene_walk(*scene, settings));
    tracer.closest_hits(rays, answers.closest);
    tracer.any_hits(rays, answers.occluded);
    return answers;
}

/// Rays at the origin from all sides and from near it, at four biases, some short and some along an axis.
inline std::vector<cpu::TraceRay> make_rays(uint32_t count, uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    std::vector<cpu::TraceRay> rays;
    for (uint32_t k = 0; k < count; ++k) {
        cpu::TraceRay ray;
        ray.origin =
            normalize(Vec3f{normal(random), normal(random), normal(random)}) * (k % 3 == 0 ? 0.3f : 4.0f);
        ray.direction = Vec3f{normal(random), normal(random), normal(random)} * 0.7f - ray.origin;
        if (k % 7 == 0) ray.direction.x = 0;
        if (k % 5 == 0) ray.t_max = 0.9f;
        ray.lod_bias = k % 4;
        rays.push_back(ray);
    }
    return rays;
}

/// Each at a point in a triangle of the mesh, from not far away.
inline std::vector<cpu::TraceRay> make_rays_at_polygons(const Mesh& mesh, uint32_t count) {
    std::mt19937 random(11);
    std::vector<cpu::TraceRay> rays(count);
    for (uint32_t k = 0; k < count; ++k) {
        const size_t face = k % 2 ? random() % mesh.face_sizes.size() : k / 2 % 30;
        const auto corner = [&](size_t c) { return mesh.positions[mesh.position_indices[3 * face + c]]; };
        const Vec3f target = corner(0) * 0.4f + corner(1) * 0.3f + corner(2) * 0.3f;
        rays[k].origin = target + (corner(1) - corner(0)) * 0.2f + Vec3f{0.01f, 0.02f, 0.3f};
        rays[k].direction = target - rays[k].origin;
    }
    return rays;
}

/// A displaced sphere, its mirrored instance, and a plain one.
inline Scene make_scene(DisplacementSpace space) {
    Scene scene =
        make_body_scene(make_cube_sphere(2), make_displacement(make_random_map(64, 48, 0.15f, 3), space));
    Object second = scene.objects[0];
    second.world_from_object = compose(make_translation({1.4f, 0.2f, 0}), make_scale({-0.5f, 0.7f, 0.6f}));
    Object plain = scene.objects[0];
    plain.displacement = kNoIndex;
    plain.world_from_object = compose(make_translation({-1.2f, 0.5f, 0.3f}), make_scale({0.6f, 0.6f, 0.6f}));
    scene.objects.push_back(second);
    scene.objects.push_back(plain);
    scene.camera.from = {2.5f, 0.4f, 0.6f};
    scene.camera.to = {0, 0, 0};
    return scene;
}

/// Many small copies, so that the tree of instances is deep.
inline Scene make_crowd() {
    Scene scene = make_scene(DisplacementSpace::tangent);
    for (int k = 0; k < 40; ++k) {
        Object copy = scene.objects[size_t(k) % 3];
        const float a = 0.37f * float(k);
        copy.world_from_object = compose(make_translation({std::cos(a), 0.05f * float(k) - 1, std::sin(a)}),
                                         make_scale({0.2f, 0.15f, 0.2f}));
        scene.objects.push_back(copy);
    }
    return scene;
}

} // namespace relief::test
