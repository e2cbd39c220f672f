// Whether a ray hits a displaced scene, in double precision and without any tree: decides whether a ray that
// left a closed body went through a hole, or started outside because its origin was rounded.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "cpu/tracer.h"
#include "math/vec_double.h"
#include "prepare/prepared_scene.h"

namespace relief::test {

class ExactScene {
  public:
    explicit ExactScene(const PreparedScene& scene) : scene_(scene) {}

    /// Finds hits with t above 0 on micro-triangles at the levels of the ray's bias. A hit on an edge counts
    /// for both of its triangles.
    bool hits(const cpu::TraceRay& ray) const {
        return std::ranges::any_of(scene_.instances,
                                   [&](const Instance& instance) { return hits(instance, ray); });
    }

  private:
    static Vec3d place(const Affine& world_from_object, const Vec3f& p) {
        const Vec3d at = to_double(p);
        const auto& rows = world_from_object.rows;
        return Vec3d{dot(to_double(rows[0]), at), dot(to_double(rows[1]), at), dot(to_double(rows[2]), at)} +
               to_double(world_from_object.translation);
    }

    bool hits(const Instance& instance, const cpu::TraceRay& ray) const {
        const Surface& surface = scene_.surfaces[instance.surface];
        std::vector<Vec3d> grid;
        for (uint32_t patch = 0; patch < surface.patch_count(); ++patch) {
            const PatchLevels levels = instance.levels->at(patch).biased(ray.lod_bias);
            const uint32_t side = 1u << levels.patch;
            grid.clear();
            for (uint32_t j = 0; j <= side; ++j)
                for (uint32_t i = 0; i <= side; ++i)
                    grid.push_back(
                        place(instance.world_from_object, evaluate_vertex(surface, patch, levels, i, j)));
            const auto vertex = [&](uint32_t i, uint32_t j) { return grid[j * (side + 1) + i]; };
            for (uint32_t j = 0; j < side; ++j)
                for (uint32_t i = 0; i < side; ++i) {
                    const Vec3d a = vertex(i, j), c = vertex(i + 1, j + 1);
                    if (hits(a, vertex(i + 1, j), c, ray) || hits(a, c, vertex(i, j + 1), ray)) return true;
                }
        }
        return false;
    }

    /// By the signs of three volumes: each edge is seen the same way by both of its triangles.
    static bool hits(const Vec3d& a, const Vec3d& b, const Vec3d& c, const cpu::TraceRay& ray) {
        const Vec3d origin = to_double(ray.origin), direction = to_double(ray.direction);
        const Vec3d p = a - origin, q = b - origin, r = c - origin;
        const double u = dot(cross(q, r), direction), v = dot(cross(r, p), direction),
                     w = dot(cross(p, q), direction);
        if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
        const double sum = u + v + w;
        if (sum == 0) return false;
        const Vec3d at = p * (u / sum) + q * (v / sum) + r * (w / sum);
        return dot(at, direction) > 0;
    }

    const PreparedScene& scene_;
};

} // namespace relief::test
