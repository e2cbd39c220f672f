#include "bench/tree_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "common/vectors.h"

namespace relief::bench {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;

Vec3f add(const Vec3f& a, const Vec3f& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec3f subtract(const Vec3f& a, const Vec3f& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec3f scale(const Vec3f& a, float s) { return {a.x * s, a.y * s, a.z * s}; }
using vectors::cross, vectors::dot;
Vec3f make_unit(const Vec3f& a) { return scale(a, 1 / std::sqrt(dot(a, a))); }

/// Hash to [0, 1) (finaliser of MurmurHash3).
float make_fraction(uint32_t number) {
    number = (number ^ number >> 16) * 0x85ebca6bu;
    number = (number ^ number >> 13) * 0xc2b2ae35u;
    return float((number ^ number >> 16) >> 8) * 0x1p-24f;
}

float compute_diagonal(const Mesh& mesh) {
    Vec3f lower = mesh.positions.at(0), upper = lower;
    for (const Vec3f& p : mesh.positions) {
        lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
        upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
    }
    const Vec3f extent = subtract(upper, lower);
    return std::sqrt(dot(extent, extent));
}

} // namespace

std::vector<std::array<uint32_t, 3>> list_triangles(const Mesh& mesh) {
    std::vector<std::array<uint32_t, 3>> triangles;
    size_t first = 0;
    for (const uint32_t corners : mesh.face_sizes) {
        for (uint32_t k = 2; k < corners; ++k)
            triangles.push_back({mesh.position_indices[first], mesh.position_indices[first + k - 1],
                                 mesh.position_indices[first + k]});
        first += corners;
    }
    return triangles;
}

RaySet make_primary_rays(const Camera& camera, int width, int height) {
    const Vec3f ahead = make_unit(subtract(camera.to, camera.from));
    const Vec3f right = make_unit(cross(ahead, camera.up)), up = cross(right, ahead);
    const float half_height = std::tan(camera.fov_degrees * kPi / 360);
    RaySet set{"primary", HitKind::closest, {}, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float sx = (2 * (float(x) + 0.5f) - float(width)) / float(height) * half_height;
            const float sy = (1 - 2 * (float(y) + 0.5f) / float(height)) * half_height;
            Ray ray;
            ray.origin = camera.from;
            ray.direction = make_unit(add(ahead, add(scale(right, sx), scale(up, sy))));
            set.rays.push_back(ray);
        }
    return set;
}

Vec3f draw_cosine_direction(const Vec3f& normal, uint32_t number) {
    const float u = make_fraction(2 * number), v = make_fraction(2 * number + 1);
    const Vec3f helper = std::fabs(normal.x) > 0.7f ? Vec3f{0, 1, 0} : Vec3f{1, 0, 0};
    const Vec3f side = make_unit(cross(helper, normal)), other = cross(normal, side);
    const float radius = std::sqrt(u), angle = 2 * kPi * v;
    return add(add(scale(side, radius * std::cos(angle)), scale(other, radius * std::sin(angle))),
               scale(normal, std::sqrt(std::max(1 - u, 1e-6f))));
}

std::vector<RaySet> make_secondary_rays(const Mesh& mesh, const RaySet& primary,
                                        const std::vector<TreeHit>& hits, const Vec3f& to_light) {
    std::vector<RaySet> sets = {{"shadow", HitKind::any, {}, {}},
                                {"occlusion", HitKind::any, {}, {}},
                                {"diffuse", HitKind::closest, {}, {}}};
    const auto triangles = list_triangles(mesh);
    const float diagonal = compute_diagonal(mesh);
    for (uint32_t k = 0; k < hits.size(); ++k) {
        if (hits[k].primitive == kNoIndex) continue;
        const auto& [a, b, c] = triangles.at(hits[k].primitive);
        const Vec3f &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
        Vec3f normal = cross(subtract(q, p), subtract(r, p));
        // Degenerate triangles without a normal spawn no rays.
        if (!(dot(normal, normal) > 1e-30f)) continue;
        normal = make_unit(normal);
        const Ray& seen = primary.rays[k];
        if (dot(normal, seen.direction) > 0) normal = scale(normal, -1);
        Ray ray;
        ray.origin = add(seen.origin, scale(seen.direction, hits[k].t));
        ray.t_min = 1e-4f * diagonal;
        const Vec3f directions[] = {make_unit(to_light), draw_cosine_direction(normal, 2 * k),
                                    draw_cosine_direction(normal, 2 * k + 1)};
        for (size_t s = 0; s < sets.size(); ++s) {
            ray.direction = directions[s];
            ray.t_max =
                sets[s].name == "occlusion" ? 0.1f * diagonal : std::numeric_limits<float>::infinity();
            sets[s].rays.push_back(ray);
            sets[s].parents.push_back(k);
        }
    }
    return sets;
}

} // namespace relief::bench
