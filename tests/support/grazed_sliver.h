// A long and narrow rectangle, and rays that graze it a little ahead of where they start: single precision
// cannot tell whether such a hit is ahead of the origin or behind it.
#pragma once

#include <cmath>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

#include "cpu/tracer.h"
#include "math/vec.h"
#include "support/bodies.h"

namespace relief::test {

class GrazedSliver {
  public:
    Scene make_scene(bool is_displaced) const {
        Mesh mesh;
        mesh.positions = {at(0, 0), at(1, 0), at(1, 1), at(0, 1)};
        mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        mesh.face_sizes = {4};
        mesh.position_indices = mesh.uv_indices = {0, 1, 2, 3};
        if (is_displaced)
            return make_body_scene(std::move(mesh),
                                   make_displacement(make_random_map(8, 8, 0, 1), DisplacementSpace::object));
        Scene scene;
        scene.meshes = {std::move(mesh)};
        scene.objects.emplace_back();
        return scene;
    }

    /// One of the two triangles of the undisplaced rectangle, which share its diagonal.
    Scene make_triangle_scene(bool is_upper) const {
        Scene scene = make_scene(false);
        Mesh& mesh = scene.meshes[0];
        mesh.face_sizes = {3};
        if (is_upper)
            mesh.position_indices = {0, 2, 3};
        else
            mesh.position_indices = {0, 1, 2};
        mesh.uv_indices = mesh.position_indices;
        return scene;
    }

    static constexpr float kAhead = 0.05f;
    /// Of t: vertices are rounded as the ray sees them, which moves the hit by a thousand times as much.
    static constexpr float kTolerance = 0.01f;

    /// Groups of sixteen nearly parallel rays towards points well within the rectangle, half of them on its
    /// diagonal. The points lie `ahead` from the origins, which may be negative.
    std::vector<cpu::TraceRay> make_rays(size_t group_count, float ahead) const {
        const Vec3f x = normalize(along_), y = normalize(across_), normal = cross(x, y);
        std::mt19937 random(3);
        std::uniform_real_distribution<float> angle(0.5f, 1.2f), place(0.2f, 0.4f), jitter(-1e-5f, 1e-5f);
        std::vector<cpu::TraceRay> rays;
        for (size_t group = 0; group < group_count; ++group) {
            const float of_group = angle(random), u = place(random);
            const float v = u + (group % 2 == 0 ? place(random) : 0.0f);
            for (int k = 0; k < 16; ++k) {
                const float a = of_group + jitter(random);
                cpu::TraceRay ray;
                ray.direction = normalize(x * std::cos(a) + y * std::sin(a) + normal * kSlope);
                ray.origin = at(u + jitter(random), v) - ray.direction * ahead;
                rays.push_back(ray);
            }
        }
        return rays;
    }

  private:
    static constexpr float kSlope = 8e-4f; ///< of rays to the triangles

    Vec3f at(float u, float v) const { return along_ * (u - 0.5f) + across_ * (v - 0.5f); }

    // Edges along no axis, 72 and 0.06 long.
    Vec3f along_ = normalize(Vec3f{0.6f, 0.7f, 0.4f}) * 72.0f;
    Vec3f across_ = normalize(cross(along_, Vec3f{0.3f, -0.2f, 0.9f})) * 0.06f;
};

} // namespace relief::test
