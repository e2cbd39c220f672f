// Objects far from the origin, rays at them from near and far, and what exact arithmetic says of the hits.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <ostream>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "math/affine.h"
#include "prepare/prepared_scene.h"
#include "relief/intersect.h"
#include "relief/render.h"
#include "support/bodies.h"

namespace relief::test {

/// Vectors in double precision: 3 x 10^5 with an error of 10^-10.
struct Exact3 {
    double x = 0, y = 0, z = 0;
    Exact3() = default;
    Exact3(double of_x, double of_y, double of_z) : x(of_x), y(of_y), z(of_z) {}
    Exact3(const Vec3f& v) : x(v.x), y(v.y), z(v.z) {}
    friend Exact3 operator+(const Exact3& a, const Exact3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Exact3 operator-(const Exact3& a, const Exact3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Exact3 operator*(const Exact3& a, double s) { return {a.x * s, a.y * s, a.z * s}; }
    friend double dot(const Exact3& a, const Exact3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
    friend Exact3 cross(const Exact3& a, const Exact3& b) {
        return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }
    friend double length(const Exact3& a) { return std::sqrt(dot(a, a)); }
};

inline Exact3 transform_exactly(const Affine& m, const Exact3& p) {
    return Exact3(dot(Exact3(m.rows[0]), p), dot(Exact3(m.rows[1]), p), dot(Exact3(m.rows[2]), p)) +
           Exact3(m.translation);
}

/// A body of size 1 and where it lies.
struct FarCase {
    const char* name;
    bool is_displaced;
    Vec3f translation{}; ///< of the object
    Vec3f mesh_offset{}; ///< of the points of its mesh
    bool is_turned = false;
    bool has_other = false; ///< a second one of its mesh lies as far on the other side
};

/// Points on a grid that holds 3 x 10^5 as well, so that the mesh can be moved there without rounding.
inline Mesh make_gridded_sphere(bool is_displaced) {
    Mesh mesh = make_cube_sphere(is_displaced ? 2 : 8);
    for (Vec3f& p : mesh.positions)
        p = {std::round(p.x * 32) / 32, std::round(p.y * 32) / 32, std::round(p.z * 32) / 32};
    return mesh;
}

inline Scene make_far_scene(const FarCase& c) {
    Scene scene =
        make_body_scene(make_gridded_sphere(c.is_displaced),
                        make_displacement(make_random_map(64, 48, 0.15f, 3), DisplacementSpace::object));
    for (Vec3f& p : scene.meshes[0].positions) p = p + c.mesh_offset;
    Object& body = scene.objects[0];
    if (!c.is_displaced) body.displacement = kNoIndex;
    if (c.is_turned)
        body.world_from_object = compose(make_rotation_degrees({20, 35, 50}), make_scale({0.7f, 0.5f, 0.6f}));
    body.world_from_object.translation = c.translation;
    if (c.has_other) {
        Object other = scene.objects[0];
        other.world_from_object.translation = -c.translation;
        scene.objects.push_back(other);
    }
    return scene;
}

/// The micro-triangles of the first object where they really are, and the places of both objects.
struct ExactBody {
    struct Triangle {
        std::array<Exact3, 3> corner;
        uint32_t patch;
    };
    struct Patch {
        size_t first = 0, end = 0; ///< triangles
        Exact3 center;
        double radius = 0;
    };
    std::vector<Triangle> triangles;
    std::vector<Patch> patches;
    Exact3 center;

    /// The surface is evaluated near the origin, where the grid of the mesh costs no digits.
    ExactBody(const FarCase& c, const IntersectorSettings& given) {
        FarCase near = c;
        near.mesh_offset = near.translation = {};
        RenderSettings settings{given.surface, given.device, {}, given.experiment};
        const auto scene = prepare_scene(make_far_scene(near), settings);
        const Affine place = make_far_scene(c).objects[0].world_from_object;
        const auto move = [&](const Vec3f& p) {
            return transform_exactly(place, Exact3(p) + Exact3(c.mesh_offset));
        };
        center = move({});
        const Surface& surface = scene->surfaces[0];
        for (uint32_t patch = 0; patch < surface.patch_count(); ++patch) {
            const Quad quad = surface.quads[patch];
            end_patch();
            if (!c.is_displaced) {
                const auto corner = [&](size_t k) { return move(surface.position(quad.vertex[k])); };
                triangles.push_back({{corner(0), corner(1), corner(2)}, patch});
                if (!quad.is_triangle()) triangles.push_back({{corner(0), corner(2), corner(3)}, patch});
                continue;
            }
            const PatchLevels levels = scene->instances[0].levels->at(patch);
            const uint32_t side = 1u << levels.patch;
            for (uint32_t j = 0; j < side; ++j)
                for (uint32_t i = 0; i < side; ++i) {
                    const auto corner = [&](uint32_t x, uint32_t y) {
                        return move(evaluate_vertex(surface, patch, levels, i + x, j + y));
                    };
                    triangles.push_back({{corner(0, 0), corner(1, 0), corner(1, 1)}, patch});
                    triangles.push_back({{corner(0, 0), corner(1, 1), corner(0, 1)}, patch});
                }
        }
        end_patch();
    }

    /// Of the triangles since the last call.
    void end_patch() {
        Patch patch{patches.empty() ? 0 : patches.back().end, triangles.size(), {}, 0};
        if (patch.first == patch.end) return;
        patch.center = triangles[patch.first].corner[0];
        for (size_t k = patch.first; k < patch.end; ++k)
            for (const Exact3& p : triangles[k].corner)
                patch.radius = std::max(patch.radius, length(p - patch.center));
        patches.push_back(patch);
    }
};

/// What a ray meets of a triangle. Beside the edge by less than kTolerance either answer is right.
struct ExactMeeting {
    bool is_possible = false, is_certain = false;
    double t = 0, t_tolerance = 0;
    Exact3 normal;
};

inline constexpr double kTolerance = 1e-5;

inline ExactMeeting meet_triangle(const Ray& ray, const ExactBody::Triangle& triangle) {
    const Exact3 d = ray.direction;
    const double speed = length(d);
    const Exact3 forward = d * (1 / speed);
    const Exact3 aside = std::fabs(forward.x) < 0.6 ? Exact3{1, 0, 0} : Exact3{0, 1, 0};
    Exact3 right = cross(forward, aside);
    right = right * (1 / length(right));
    const Exact3 up = cross(right, forward);
    double x[3], y[3];
    for (size_t k = 0; k < 3; ++k) {
        const Exact3 v = triangle.corner[k] - Exact3(ray.origin);
        x[k] = dot(v, right), y[k] = dot(v, up);
    }
    ExactMeeting meeting;
    const double area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    const double turn = area < 0 ? -1 : 1;
    double least = 1e30, nearest = 1e30;
    for (size_t k = 0; k < 3; ++k) {
        const size_t n = (k + 1) % 3;
        const double ex = x[n] - x[k], ey = y[n] - y[k], size = std::hypot(ex, ey);
        if (!(size > 0)) continue;
        least = std::min(least, turn * (x[k] * y[n] - x[n] * y[k]) / size);
        const double s = std::clamp(-(x[k] * ex + y[k] * ey) / (size * size), 0.0, 1.0);
        nearest = std::min(nearest, std::hypot(x[k] + s * ex, y[k] + s * ey));
    }
    const double inside = least >= 0 ? least : -nearest;
    if (inside < -kTolerance) return meeting;
    Exact3 normal = cross(triangle.corner[1] - triangle.corner[0], triangle.corner[2] - triangle.corner[0]);
    meeting.normal = normal = normal * (1 / length(normal));
    const double cosine = std::fabs(dot(normal, forward));
    meeting.is_possible = true;
    meeting.is_certain = inside > kTolerance && cosine > 1e-3;
    meeting.t = dot(triangle.corner[0] - Exact3(ray.origin), normal) / dot(forward, normal) / speed;
    meeting.t_tolerance = 1.2e-7 * std::fabs(meeting.t) + 2 * kTolerance / std::max(cosine, 1e-6) / speed;
    return meeting;
}

/// What all triangles together say.
struct ExactAnswer {
    bool is_certain = false, is_possible = false; ///< that something is met
    double farthest = 1e30;                       ///< t of a hit is no more
};

/// Calls visit(triangle, meeting) for those that the ray may meet.
template <class Visit> void visit_meetings(const ExactBody& body, const Ray& ray, Visit visit) {
    const Exact3 from = ray.origin, d = ray.direction;
    for (const ExactBody::Patch& patch : body.patches) {
        const Exact3 way = patch.center - from;
        if (length(way - d * (dot(way, d) / dot(d, d))) > patch.radius + kTolerance) continue;
        for (size_t k = patch.first; k < patch.end; ++k) {
            const ExactMeeting meeting = meet_triangle(ray, body.triangles[k]);
            if (meeting.is_possible && meeting.t > -meeting.t_tolerance) visit(body.triangles[k], meeting);
        }
    }
}

/// False where a hit is none, one is missing, or another lies before it, by more than rounding.
inline bool is_right(const ExactBody& body, const Ray& ray, const RayHit& hit, bool is_occluded) {
    ExactAnswer answer;
    bool is_found = hit.object == kNoIndex;
    visit_meetings(body, ray, [&](const ExactBody::Triangle& triangle, const ExactMeeting& meeting) {
        answer.is_possible = true;
        if (meeting.is_certain && meeting.t > meeting.t_tolerance) {
            answer.is_certain = true;
            answer.farthest = std::min(answer.farthest, meeting.t + meeting.t_tolerance);
        }
        is_found = is_found || (hit.object == 0 && hit.patch == triangle.patch &&
                                std::fabs(double(hit.t) - meeting.t) <= meeting.t_tolerance &&
                                dot(Exact3(hit.normal), meeting.normal) > 0.999);
    });
    if (answer.is_certain && !(double(hit.t) <= answer.farthest)) return false;
    return is_found && (is_occluded ? answer.is_possible : !answer.is_certain);
}

/// From around the body or from near the world's origin; by themselves, from one point and side by side, so
/// that they travel in all ways.
inline std::vector<Ray> make_far_rays(const ExactBody& body, bool is_near, uint32_t count) {
    std::mt19937 random(17);
    std::normal_distribution<float> normal;
    const auto draw = [&] { return Vec3f{normal(random), normal(random), normal(random)}; };
    const Vec3f center{float(body.center.x), float(body.center.y), float(body.center.z)};
    const auto choose_start = [&] { return is_near ? center + normalize(draw()) * 3.0f : draw(); };
    const auto aim = [&](const Vec3f& origin, const Vec3f& target) {
        Ray ray{origin, 0, target - origin};
        if (random() % 2) ray.direction = normalize(ray.direction);
        return ray;
    };
    std::vector<Ray> rays;
    for (uint32_t k = 0; k < count; ++k) rays.push_back(aim(choose_start(), center + draw() * 0.4f));
    const Vec3f start = choose_start();
    for (uint32_t k = 0; k < count; ++k) rays.push_back(aim(start, center + draw() * 0.5f));
    const Vec3f along = center - start;
    for (uint32_t k = 0; k < count; ++k) {
        const Vec3f aside{float(k % 16) * 0.0625f - 0.5f, float(k / 16 % 16) * 0.0625f - 0.5f, 0};
        rays.push_back({start + aside, 0, along + draw() * (is_near ? 0.01f : 0.3f)});
    }
    return rays;
}

/// How many answers of each kind of ray are wrong.
inline void expect_right_hits(const FarCase& c, IntersectorSettings settings, uint32_t count) {
    settings.surface.level = 3;
    const ExactBody body(c, settings);
    const Intersector intersector(make_far_scene(c), settings);
    for (const bool is_near : {true, false}) {
        const std::vector<Ray> rays = make_far_rays(body, is_near, count);
        std::vector<RayHit> hits(rays.size());
        std::vector<uint8_t> occluded(rays.size());
        intersector.closest_hits(rays, hits);
        intersector.any_hits(rays, occluded);
        size_t wrong = 0, hit_count = 0;
        for (size_t k = 0; k < rays.size(); ++k) {
            wrong += !is_right(body, rays[k], hits[k], occluded[k] != 0);
            hit_count += hits[k].object == 0;
        }
        EXPECT_EQ(wrong, 0u) << c.name << (is_near ? ", near" : ", far") << ", of " << rays.size();
        EXPECT_GT(hit_count, rays.size() / 4) << c.name << (is_near ? ", near" : ", far");
    }
}

/// A picture of a body that shadows itself, all of it moved by `offset`, which rounds nothing.
inline RenderResult render_moved(const Vec3f& offset, RenderSettings settings) {
    FarCase place{"moved", true};
    place.translation = offset;
    Scene scene = make_far_scene(place);
    scene.camera.from = Vec3f{2.5f, 1, 0.5f} + offset, scene.camera.to = offset;
    scene.environment = Environment{};
    Light light;
    light.type = LightType::point, light.position = Vec3f{1, 3, 2} + offset;
    light.strength = 40;
    scene.lights.push_back(light);
    settings.image.width = settings.image.height = 32;
    settings.image.spp = 16, settings.image.bounces = 1;
    settings.image.layers = {"P", "Ng"};
    settings.surface.level = 4;
    return render(std::move(scene), settings);
}

/// That a picture far from the origin is the one near it, but for places, which are as far away as they
/// should be.
inline void expect_picture_is_moved(const RenderSettings& settings) {
    const Vec3f offset{3e5f, -3e5f, 3e5f};
    const Image near = render_moved({}, settings).image, far = render_moved(offset, settings).image;
    const size_t width = near.channels.size();
    const size_t place = size_t(std::ranges::find(near.channels, "P.X") - near.channels.begin());
    ASSERT_EQ(far.pixels.size(), near.pixels.size());
    double difference = 0, sum = 0;
    size_t places = 0;
    for (size_t pixel = 0; pixel < near.pixels.size(); pixel += width) {
        for (size_t c = 0; c < 3; ++c) {
            difference += std::fabs(double(far.pixels[pixel + c]) - double(near.pixels[pixel + c]));
            sum += double(near.pixels[pixel + c]);
        }
        if (near.pixels[pixel + 3] < 1 || far.pixels[pixel + 3] < 1) continue;
        ++places;
        for (size_t c = 0; c < 3; ++c) {
            const double expected =
                double(near.pixels[pixel + place + c]) + double(get_component(offset, int(c)));
            ASSERT_NEAR(double(far.pixels[pixel + place + c]), expected, 0.04) << pixel / width;
        }
    }
    EXPECT_GT(places, 200u);
    EXPECT_LT(difference, 0.002 * sum);
}

inline void PrintTo(const FarCase& c, std::ostream* stream) { *stream << c.name; }

inline std::vector<FarCase> list_far_cases() {
    constexpr float kFar = 3e5f;
    return {
        {"body_at_the_origin", true},
        {"polygons_at_the_origin", false},
        {"body_along_x", true, {kFar, 0, 0}},
        {"body_along_y", true, {0, -kFar, 0}, {}, true},
        {"body_along_z", true, {0, 0, kFar}, {}, true, true},
        {"body_along_all", true, {kFar, kFar, -kFar}, {}, true},
        {"polygons_along_x", false, {kFar, 0, 0}, {}, true},
        {"polygons_along_all", false, {-kFar, kFar, kFar}, {}, true, true},
        {"mesh_along_x", true, {}, {kFar, 0, 0}},
        {"mesh_along_all", true, {}, {kFar, -kFar, kFar}, true},
        {"mesh_of_polygons_along_y", false, {}, {0, kFar, 0}},
        {"mesh_of_polygons_along_all", false, {}, {kFar, kFar, kFar}, true},
        {"mesh_brought_back", true, {-kFar, 0, 0}, {kFar, 0, 0}},
        {"both", true, {2e5f, 0, 1e5f}, {kFar, 0, 0}, true},
    };
}

} // namespace relief::test
