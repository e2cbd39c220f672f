// The one table of triangles and rays on which every structure and walk is held against brute force.
#pragma once

#include <algorithm>
#include <ostream>
#include <string>
#include <vector>

#include "formulas/object_ray.h"
#include "support/box_sets.h"

namespace relief::test {

struct TriangleSet {
    std::string name;
    std::vector<Triangle> triangles;

    std::vector<Box> boxes() const {
        std::vector<Box> result;
        for (const Triangle& triangle : triangles) result.push_back(triangle.box());
        return result;
    }
};

inline void PrintTo(const TriangleSet& set, std::ostream* stream) { *stream << set.name; }

/// Corners on a coarse grid, at most `reach` apart: triangles share planes, edges and vertices, and some are
/// lines or points.
inline std::vector<Triangle> make_grid_triangles(uint32_t seed, size_t count, uint32_t side, uint32_t reach) {
    std::mt19937 random(seed);
    const auto point = [&](uint32_t size) {
        const float x = float(random() % size), y = float(random() % size), z = float(random() % size);
        return Vec3f{x, y, z};
    };
    std::vector<Triangle> triangles(count);
    for (Triangle& triangle : triangles) {
        const Vec3f corner = point(side);
        triangle = {corner + point(reach + 1), corner + point(reach + 1), corner + point(reach + 1)};
    }
    return triangles;
}

/// A square floor at height z, its vertices off by up to `noise` units of 2^-24.
inline std::vector<Triangle> make_floor(uint32_t seed, int side, float z, uint32_t noise) {
    std::mt19937 random(seed);
    std::vector<Vec3f> points;
    for (int i = 0; i <= side; ++i)
        for (int j = 0; j <= side; ++j)
            points.push_back(
                {float(i), float(j), z + z * float(noise > 0 ? random() % noise : 0) * 0x1p-23f});
    std::vector<Triangle> triangles;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            const size_t k = size_t(i * (side + 1) + j), above = k + size_t(side) + 1;
            triangles.push_back({points[k], points[above], points[above + 1]});
            triangles.push_back({points[k], points[above + 1], points[k + 1]});
        }
    return triangles;
}

/// The noisy floor with something above and below it: a cell may be cut out that is as thin as the noise.
inline std::vector<Triangle> make_floor_between(uint32_t seed, int side, float z, uint32_t noise) {
    std::vector<Triangle> triangles = make_floor(seed, side, z, noise);
    for (const float height : {z - 2, z + 2})
        triangles.push_back({{0, 0, height}, {0.2f, 0, height + 0.1f}, {0, 0.2f, height}});
    return triangles;
}

inline std::vector<Triangle> move(std::vector<Triangle> triangles, const Vec3f& offset) {
    for (Triangle& t : triangles) t = {t.a + offset, t.b + offset, t.c + offset};
    return triangles;
}

/// In planes across each axis, some repeated, some no more than a point.
inline std::vector<Triangle> make_flat_triangles() {
    std::vector<Triangle> triangles = make_random_triangles(7, 200, 1, 0.7f);
    for (size_t k = 0; k < triangles.size(); ++k)
        for (Vec3f* p : {&triangles[k].a, &triangles[k].b, &triangles[k].c})
            set_component(*p, int(k % 3), 0.25f);
    triangles.insert(triangles.end(), triangles.begin(), triangles.begin() + 100);
    triangles.insert(triangles.end(), 20, Triangle{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
    return triangles;
}

inline std::vector<TriangleSet> make_triangle_sets() {
    std::vector<TriangleSet> sets;
    sets.push_back({"none", {}});
    sets.push_back({"one", make_random_triangles(20, 1, 1, 1)});
    sets.push_back({"two", make_random_triangles(21, 2, 1, 1)});
    sets.push_back({"random", make_random_triangles(22, 400, 1, 0.4f)});
    sets.push_back({"many small", make_random_triangles(23, 3000, 1, 0.05f)});
    sets.push_back({"many large", make_random_triangles(24, 150, 1, 3)});
    sets.push_back({"on a coarse grid", make_grid_triangles(25, 300, 4, 2)});
    sets.push_back({"flat and repeated", make_flat_triangles()});
    sets.push_back({"floor", make_floor(26, 12, 0, 0)});
    sets.push_back({"floor with noise", make_floor_between(27, 12, 0.3f, 5)});
    sets.push_back(
        {"all the same", std::vector<Triangle>(150, Triangle{{0, 0, 0}, {1, 0, 0.5f}, {0, 1, 0}})});
    sets.push_back({"points", std::vector<Triangle>(60, Triangle{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}})});
    sets.push_back({"huge", make_random_triangles(28, 300, 1e12f, 4e11f)});
    sets.push_back({"tiny", make_random_triangles(29, 300, 1e-12f, 4e-13f)});
    sets.push_back({"as huge as floats go", make_random_triangles(33, 100, 1e30f, 4e29f)});
    sets.push_back({"as tiny as floats go", make_random_triangles(34, 100, 1e-30f, 4e-31f)});
    sets.push_back({"far from the origin", move(make_random_triangles(30, 300, 1, 0.3f), {1e4f, -1e4f, 10})});
    sets.push_back({"mixed sizes", make_random_triangles(31, 150, 1, 1e-3f)});
    for (const Triangle& triangle : make_random_triangles(32, 60, 300, 300))
        sets.back().triangles.push_back(triangle);
    return sets;
}

/// Wider than the triangles, so that it is not flat where they are.
inline Box compute_bounds(const std::vector<Triangle>& triangles) {
    Box box;
    for (const Triangle& triangle : triangles) box.extend(triangle.box());
    if (box.is_empty()) box = {{-1, -1, -1}, {1, 1, 1}};
    const Vec3f extent = box.extent();
    const float margin = 0.2f * std::max({extent.x, extent.y, extent.z});
    return {box.lower - Vec3f{margin, margin, margin}, box.upper + Vec3f{margin, margin, margin}};
}

/// Rays that meet the triangles in general and in special places.
class RayMaker {
  public:
    RayMaker(uint32_t seed, const std::vector<Triangle>& triangles)
        : random_(seed), triangles_(triangles), bounds_(compute_bounds(triangles)) {}

    /// From in or around the set, or (some) from far or very far away, towards a point in it.
    BoxRay make_general() {
        const Vec3f target = inside();
        Vec3f origin = inside();
        const uint32_t place = random_() % 32;
        const float away = place < 4 ? 50.0f : place < 5 ? 5000.0f : 1.0f;
        origin = target + (origin - target) * (2 * away);
        return make(origin, target - origin);
    }

    /// Through a vertex or a point of an edge; from another one, from inside, or along an axis; in planes
    /// across an axis; zeros of both signs.
    BoxRay make_special() {
        const Vec3f target = corner();
        Vec3f origin = target, direction{};
        switch (random_() % 5) {
        case 0:
            origin = corner();
            break;
        case 1:
            origin = inside();
            break;
        case 2: // along an axis
            set_component(direction, int(random_() % 3), random_() % 2 ? -1.0f : 1.0f);
            origin = target - direction * (float(random_() % 4) * size());
            return make(origin, direction);
        case 3: // in a plane across an axis
            origin = inside();
            set_component(origin, int(random_() % 3), 0);
            origin = in_plane_with(target, origin);
            break;
        default:
            origin = target - (inside() - target);
            break;
        }
        direction = target - origin;
        if (random_() % 4 == 0) origin = origin - direction;
        return make(origin, direction);
    }

  private:
    float size() const {
        const Vec3f e = bounds_.extent();
        return std::max({e.x, e.y, e.z});
    }

    Vec3f inside() {
        std::uniform_real_distribution<float> unit(0, 1);
        const Vec3f e = bounds_.extent();
        const float x = unit(random_), y = unit(random_), z = unit(random_);
        return bounds_.lower + Vec3f{e.x * x, e.y * y, e.z * z};
    }

    /// A vertex, or the middle of an edge.
    Vec3f corner() {
        if (triangles_.empty()) return inside();
        const Triangle& triangle = triangles_[random_() % triangles_.size()];
        const Vec3f corners[] = {triangle.a, triangle.b, triangle.c};
        const Vec3f one = corners[random_() % 3], other = corners[random_() % 3];
        return one * 0.5f + other * 0.5f;
    }

    Vec3f in_plane_with(const Vec3f& target, Vec3f origin) {
        const int axis = int(random_() % 3);
        set_component(origin, axis, get_component(target, axis));
        return origin;
    }

    BoxRay make(const Vec3f& origin, Vec3f direction) {
        direction = normalize(direction);
        if (length(direction) == 0) direction = {0, -0.0f, 1};
        if (random_() % 16 == 0) direction = direction * 1e-3f;
        BoxRay ray{origin, direction};
        if (random_() % 8 == 0) ray.t_min = 0.25f * size();
        if (random_() % 8 == 0) ray.t_max = ray.t_min + 0.5f * size();
        return ray;
    }

    std::mt19937 random_;
    const std::vector<Triangle>& triangles_;
    Box bounds_;
};

struct Nearest {
    float t = std::numeric_limits<float>::infinity();
    uint32_t id = 0xffffffffu;
    bool is_hit() const { return id != 0xffffffffu; }
    bool operator==(const Nearest&) const = default;
};

/// The test that engines run. It may find what a walk need not: see is_doubtful.
inline float intersect_as_engines_do(const BoxRay& ray, const Triangle& triangle) {
    const scalar::ObjectRay own = scalar::make_object_ray(ray.origin, ray.direction);
    return scalar::intersect_sheared(own, scalar::shear_vertex(own, triangle.a),
                                     scalar::shear_vertex(own, triangle.b),
                                     scalar::shear_vertex(own, triangle.c), ray.t_min, ray.t_max)
        .t;
}

/// In double precision.
inline bool misses_box(const BoxRay& ray, const Box& box) {
    double entry = ray.t_min, exit = ray.t_max;
    for (int axis = 0; axis < 3; ++axis) {
        const double origin = get_component(ray.origin, axis), speed = get_component(ray.direction, axis);
        const double lower = get_component(box.lower, axis), upper = get_component(box.upper, axis);
        if (speed == 0 && (origin < lower || origin > upper)) return true;
        if (speed == 0) continue;
        const double first = (lower - origin) / speed, last = (upper - origin) / speed;
        entry = std::max(entry, std::min(first, last));
        exit = std::min(exit, std::max(first, last));
    }
    return entry > exit * (1 + 1e-12);
}

/// Whether a ray that ends at a hit of the triangle at `t` does not come into the triangle's box, by the test
/// that engines run.
inline bool ends_before_box(const BoxRay& ray, const Triangle& triangle, float t) {
    const scalar::ObjectRay own = scalar::make_object_ray(ray.origin, ray.direction);
    const Box box = triangle.box();
    return !scalar::is_box_met(scalar::cross_box(own, box.lower, box.upper, ray.t_min, t));
}

/// Whether rounding lets the ray hit a triangle whose own box it misses: walks may find it or not.
inline bool is_doubtful(const std::vector<Triangle>& triangles, const BoxRay& ray) {
    return std::any_of(triangles.begin(), triangles.end(), [&](const Triangle& triangle) {
        const float t = intersect_as_engines_do(ray, triangle);
        if (t == std::numeric_limits<float>::infinity()) return false;
        return misses_box(ray, triangle.box()) || ends_before_box(ray, triangle, t);
    });
}

/// Distance of a hit or infinity.
using Intersect = float (*)(const BoxRay&, const Triangle&);

/// Leaf of a closest-hit walk: the nearest triangle, of equally near ones the first.
template <Intersect kIntersect = intersect> class NearestLeaf {
  public:
    explicit NearestLeaf(const std::vector<Triangle>& triangles) : triangles_(triangles) {}

    void operator()(uint32_t id, BoxRay& ray) {
        const float t = kIntersect(ray, triangles_[id]);
        if (t == std::numeric_limits<float>::infinity()) return;
        if (t < best.t || (t == best.t && id < best.id)) best = {t, id}, ray.t_max = t;
    }

    Nearest best;

  private:
    const std::vector<Triangle>& triangles_;
};

/// Leaf of an any-hit walk.
template <Intersect kIntersect = intersect> class AnyLeaf {
  public:
    explicit AnyLeaf(const std::vector<Triangle>& triangles) : triangles_(triangles) {}
    bool operator()(uint32_t id, const BoxRay& ray) const {
        return kIntersect(ray, triangles_[id]) < std::numeric_limits<float>::infinity();
    }

  private:
    const std::vector<Triangle>& triangles_;
};

template <Intersect kIntersect = intersect>
Nearest find_by_brute_force(const std::vector<Triangle>& triangles, BoxRay ray) {
    NearestLeaf<kIntersect> leaf(triangles);
    for (uint32_t id = 0; id < triangles.size(); ++id) leaf(id, ray);
    return leaf.best;
}

} // namespace relief::test
