// Sets of boxes and rays that every structure has to survive, and a scalar triangle test.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "lab/walks/walks.h"
#include "math/box.h"

namespace relief::test {

struct BoxSet {
    std::string name;
    std::vector<Box> boxes;
};

inline Vec3f make_point(std::mt19937& random, float size) {
    std::uniform_real_distribution<float> unit(-1, 1);
    const float x = unit(random), y = unit(random), z = unit(random);
    return Vec3f{x, y, z} * size;
}

inline std::vector<Box> make_random_boxes(uint32_t seed, size_t count, float scene_size, float box_size,
                                          const Vec3f& squash = {1, 1, 1}) {
    std::mt19937 random(seed);
    std::vector<Box> boxes(count);
    for (Box& box : boxes) {
        const Vec3f corner = make_point(random, scene_size) * squash;
        box.extend(corner);
        box.extend(corner + make_point(random, box_size) * squash);
    }
    return boxes;
}

/// Boxes around the same corner that double in size: their centroids are as unevenly spread as floats allow.
inline std::vector<Box> make_nested_boxes() {
    std::vector<Box> boxes;
    for (int k = -100; k < 100; ++k) boxes.push_back({{0, 0, 0}, Vec3f{1, 1, 1} * std::ldexp(1.0f, k)});
    return boxes;
}

inline std::vector<BoxSet> make_box_sets() {
    std::vector<BoxSet> sets;
    sets.push_back({"one", make_random_boxes(1, 1, 1, 1)});
    sets.push_back({"two", make_random_boxes(2, 2, 1, 1)});
    sets.push_back({"nine", make_random_boxes(3, 9, 1, 0.1f)});
    sets.push_back({"many small", make_random_boxes(4, 3000, 10, 0.1f)});
    sets.push_back({"many overlapping", make_random_boxes(5, 500, 1, 2)});
    sets.push_back({"identical", std::vector<Box>(300, Box{{1, 2, 3}, {2, 3, 5}})});
    sets.push_back({"identical points", std::vector<Box>(100, Box{{1, 2, 3}, {1, 2, 3}})});
    sets.push_back({"flat in y", make_random_boxes(6, 700, 5, 0.2f, {1, 0, 1})});
    sets.push_back({"on a line", make_random_boxes(7, 700, 5, 0.2f, {1, 0, 0})});
    sets.push_back({"points", make_random_boxes(8, 700, 5, 0)});
    sets.push_back({"huge", make_random_boxes(9, 700, 1e30f, 1e29f)});
    sets.push_back({"tiny", make_random_boxes(10, 700, 1e-30f, 1e-31f)});
    sets.push_back({"small and far away", make_random_boxes(11, 700, 1e-3f, 1e-4f)});
    for (Box& box : sets.back().boxes)
        box = {box.lower + Vec3f{1e4f, -1e4f, 0}, box.upper + Vec3f{1e4f, -1e4f, 0}};
    sets.push_back({"nested", make_nested_boxes()});
    sets.push_back({"mixed sizes", make_random_boxes(12, 300, 1, 1e-3f)});
    for (const Box& box : make_random_boxes(13, 300, 1e12f, 1e12f)) sets.back().boxes.push_back(box);
    return sets;
}

inline Box compute_union(const std::vector<Box>& boxes) {
    Box all;
    for (const Box& box : boxes) all.extend(box);
    return all;
}

struct Triangle {
    Vec3f a, b, c;
    Box box() const {
        Box result;
        result.extend(a), result.extend(b), result.extend(c);
        return result;
    }
};

inline std::vector<Triangle> make_random_triangles(uint32_t seed, size_t count, float scene_size,
                                                   float size) {
    std::mt19937 random(seed);
    std::vector<Triangle> triangles(count);
    for (Triangle& t : triangles) {
        t.a = make_point(random, scene_size);
        t.b = t.a + make_point(random, size);
        t.c = t.a + make_point(random, size);
    }
    return triangles;
}

/// Distance in double precision (Moeller and Trumbore 1997); infinity for a miss.
inline float intersect(const BoxRay& ray, const Triangle& triangle) {
    struct Double3 {
        double x, y, z;
    };
    const auto subtract = [](const Vec3f& a, const Vec3f& b) {
        return Double3{double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z};
    };
    const auto cross3 = [](const Double3& a, const Double3& b) {
        return Double3{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    };
    const auto dot3 = [](const Double3& a, const Double3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; };
    const float miss = std::numeric_limits<float>::infinity();
    const Double3 direction = subtract(ray.direction, {});
    const Double3 edge1 = subtract(triangle.b, triangle.a), edge2 = subtract(triangle.c, triangle.a);
    const Double3 p = cross3(direction, edge2);
    const double determinant = dot3(edge1, p);
    if (determinant == 0) return miss;
    const Double3 s = subtract(ray.origin, triangle.a);
    const double u = dot3(s, p) / determinant;
    const Double3 q = cross3(s, edge1);
    const double v = dot3(direction, q) / determinant;
    if (!(u >= 0 && v >= 0 && u + v <= 1)) return miss;
    const float t = float(dot3(edge2, q) / determinant);
    return t >= ray.t_min && t <= ray.t_max ? t : miss;
}

/// From anywhere in or around the scene in any direction; every third ray is parallel to an axis or a plane
/// of axes.
inline std::vector<BoxRay> make_rays(uint32_t seed, size_t count, float scene_size) {
    std::mt19937 random(seed);
    std::vector<BoxRay> rays(count);
    for (size_t k = 0; k < count; ++k) {
        rays[k].origin = make_point(random, 2 * scene_size);
        rays[k].direction = normalize(make_point(random, scene_size) - rays[k].origin);
        if (k % 3 == 0) set_component(rays[k].direction, int(k / 3 % 3), 0);
        if (k % 9 == 0) set_component(rays[k].direction, int(k / 9 % 3), -0.0f);
        if (length(rays[k].direction) == 0) rays[k].direction = {0, 0, 1};
    }
    return rays;
}

} // namespace relief::test
