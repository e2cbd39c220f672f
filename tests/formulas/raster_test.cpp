// Rectangles of pixels hold every ray that meets a triangle, and not much more.
#include <gtest/gtest.h>

#include "formulas/camera.h"
#include "formulas/object_ray.h"
#include "formulas/raster.h"
#include "math/affine.h"
#include "statistics.h"

namespace relief {
namespace {

constexpr float kWidth = 640, kHeight = 360;

Vec3f sum_magnitudes(const Affine& m, const Vec3f& v) {
    const auto magnitudes = [](const Vec3f& a) {
        return Vec3f{std::fabs(a.x), std::fabs(a.y), std::fabs(a.z)};
    };
    return {dot(magnitudes(m.rows[0]), magnitudes(v)), dot(magnitudes(m.rows[1]), magnitudes(v)),
            dot(magnitudes(m.rows[2]), magnitudes(v))};
}

/// A camera, the transform of an object, and what rays and rectangles see of it.
struct View {
    scalar::CameraFrame frame;
    Affine object_from_world;

    scalar::ObjectCamera object_camera() const {
        const auto turn = [&](const Vec3f& v) { return transform_vector(object_from_world, v); };
        const auto bound = [&](const Vec3f& v) { return sum_magnitudes(object_from_world, v); };
        const scalar::CameraVectors vectors{turn(frame.corner), turn(frame.step_x), turn(frame.step_y)};
        const scalar::CameraVectors bounds{bound(frame.corner), bound(frame.step_x), bound(frame.step_y)};
        const Vec3f reach = bounds.corner + bounds.step_x * kWidth + bounds.step_y * kHeight;
        return scalar::make_object_camera(transform_point(object_from_world, frame.origin), vectors, bounds,
                                          reach);
    }
    scalar::ObjectRay object_ray(const Vec2f& pixel) const {
        const scalar::CameraRay ray = scalar::make_pinhole_ray(frame, pixel);
        return scalar::make_object_ray(transform_point(object_from_world, ray.origin),
                                       transform_vector(object_from_world, ray.direction));
    }
};

View make_view(const Affine& object_from_world) {
    return {scalar::make_camera_frame({1, 2, 5}, {0.5f, 0, -1}, {0, 1, 0}, 0.7f, {kWidth, kHeight}),
            object_from_world};
}

Vec3f draw_vector(Random& random) {
    const float x = random.next(), y = random.next();
    return Vec3f{x, y, random.next()} * 2.0f - Vec3f{1, 1, 1};
}

struct Triangle {
    Vec3f a, b, c;
};

/// Around a point of the ray: inside, or on an edge.
Triangle draw_triangle(Random& random, const scalar::ObjectRay& ray, float size) {
    const float distance = std::exp2(12 * random.next() - 6);
    const Vec3f p = ray.origin + ray.direction * distance;
    const Vec3f a = p + draw_vector(random) * size, b = p + draw_vector(random) * size;
    if (random.next() < 0.3f) return {a, p * 2.0f - a, b};
    return {a, b, p * 3.0f - a - b};
}

bool is_met(const scalar::ObjectRay& ray, const Triangle& t) {
    const float all = std::numeric_limits<float>::infinity();
    return scalar::intersect_sheared(ray, scalar::shear_vertex(ray, t.a), scalar::shear_vertex(ray, t.b),
                                     scalar::shear_vertex(ray, t.c), 0, all)
               .t != all;
}

TEST(Raster, holds_every_ray_that_meets_a_triangle) {
    const Affine turned = make_rotation_degrees({20, 70, -30});
    const Affine transforms[] = {
        Affine{},
        compose(make_translation({3, -200, 1}), turned),
        compose(make_scale({-1e-6f, 1e-6f, 2e-6f}), turned),
        compose(make_scale({1e5f, 2e5f, -1e5f}), turned),
        compose(turned, compose(make_scale({1, 0.001f, 1}), turned)),
        compose(turned, compose(make_scale({1e-4f, 1, 100}), turned)),
    };
    Random random(7);
    int met = 0, cut = 0;
    for (const Affine& transform : transforms) {
        const View view = make_view(transform);
        const scalar::ObjectCamera camera = view.object_camera();
        const float unit = length(view.object_ray({300, 200}).direction);
        for (int k = 0; k < 20000; ++k) {
            const Vec2f pixel{random.next() * kWidth, random.next() * kHeight};
            const scalar::ObjectRay ray = view.object_ray(pixel);
            const Triangle t = draw_triangle(random, ray, unit * std::exp2(24 * random.next() - 16));
            if (!is_met(ray, t)) continue;
            ++met;
            const scalar::ScreenBox box = scalar::bound_on_screen(camera, t.a, t.b, t.c, t.c);
            cut += box.x0 > 0 || box.y0 > 0 || box.x1 < kWidth || box.y1 < kHeight;
            ASSERT_LE(box.x0, pixel.x + 0.01f) << k;
            ASSERT_GE(box.x1, pixel.x - 0.01f) << k;
            ASSERT_LE(box.y0, pixel.y + 0.01f) << k;
            ASSERT_GE(box.y1, pixel.y - 0.01f) << k;
        }
    }
    EXPECT_GT(met, 50000);
    EXPECT_GT(cut, met / 2);
}

TEST(Raster, is_tight_around_what_lies_in_front) {
    const View view = make_view(Affine{});
    const scalar::ObjectCamera camera = view.object_camera();
    Random random(8);
    for (int k = 0; k < 1000; ++k) {
        const Vec2f from{random.next() * kWidth, random.next() * kHeight};
        Vec3f p[3];
        float x0 = 1e9f, x1 = -1e9f, y0 = 1e9f, y1 = -1e9f;
        for (Vec3f& point : p) {
            const Vec2f pixel = from + random.next_pair() * 20.0f;
            const scalar::CameraRay ray = scalar::make_pinhole_ray(view.frame, pixel);
            point = ray.origin + ray.direction * (1 + 5 * random.next());
            x0 = std::min(x0, pixel.x), x1 = std::max(x1, pixel.x);
            y0 = std::min(y0, pixel.y), y1 = std::max(y1, pixel.y);
        }
        const scalar::ScreenBox box = scalar::bound_on_screen(camera, p[0], p[1], p[2], p[2]);
        ASSERT_NEAR(box.x0, x0, 0.25f);
        ASSERT_NEAR(box.x1, x1, 0.25f);
        ASSERT_NEAR(box.y0, y0, 0.25f);
        ASSERT_NEAR(box.y1, y1, 0.25f);
    }
}

TEST(Raster, leaves_out_what_lies_behind_and_what_passes_below) {
    View view = make_view(Affine{});
    view.frame = scalar::make_camera_frame({0, 1, 0}, {0, 1, -1}, {0, 1, 0}, 0.7f, {kWidth, kHeight});
    const scalar::ObjectCamera camera = view.object_camera();
    const scalar::ScreenBox behind =
        scalar::bound_on_screen(camera, {0, 0, 1}, {1, 0, 2}, {0, 1, 3}, {0, 1, 3});
    EXPECT_GT(behind.x0, behind.x1);
    // Cells of a floor under the feet, half in front and half behind.
    const scalar::ScreenBox floor =
        scalar::bound_on_screen(camera, {-1, 0, -0.5f}, {1, 0, -0.5f}, {1, 0, 0.5f}, {-1, 0, 0.5f});
    EXPECT_GT(floor.y0, kHeight);
    // A wall beside the camera reaches into the picture.
    const scalar::ScreenBox wall =
        scalar::bound_on_screen(camera, {1, 0, -9}, {1, 2, -9}, {1, 2, 1}, {1, 0, 1});
    EXPECT_GT(wall.x0, 0.5f * kWidth);
    EXPECT_LT(wall.x0, kWidth);
    EXPECT_EQ(wall.x1, std::numeric_limits<float>::infinity());
    // In the plane of the camera nothing is known.
    const scalar::ScreenBox all =
        scalar::bound_on_screen(camera, {0, 1, 0}, {1, 1, -1}, {1, 1, -2}, {1, 1, -2});
    EXPECT_EQ(all.x0, -std::numeric_limits<float>::infinity());
}

} // namespace
} // namespace relief
