// Tolerances of automatic subdivision levels by the view.
#include "prepare/surface_recipe.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace relief {

namespace {

/// Two quads, of which the second one is at x = 9.
Mesh make_quads() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0},  {1, 1, 0},  {0, 1, 0},
                      {9, 0, 0}, {10, 0, 0}, {10, 1, 0}, {9, 1, 0}};
    mesh.face_sizes = {4, 4};
    mesh.position_indices = {0, 1, 2, 3, 4, 5, 6, 7};
    return mesh;
}

LevelFieldConfig make_view(const Vec3f& camera) {
    LevelFieldConfig config;
    config.camera = camera, config.pixel_angle = 1e-3f;
    return config;
}

double choose(const Mesh& mesh, const Affine& place, const Vec3f& camera, double reach = 0) {
    const std::array places = {place};
    return choose_base_tolerance(mesh, places, reach, make_view(camera)).of_face(0);
}

TEST(BaseTolerances, are_a_tenth_of_a_pixel_where_the_mesh_is_nearest) {
    const double tolerance = choose(make_quads(), {}, {0.5f, 0.5f, 100});
    EXPECT_LE(tolerance, 0.1 * 1e-3 * 100);
    EXPECT_GT(tolerance, 0.1 * 1e-3 * 100 / 1.5) << "rounded down by less than the root of two";
    EXPECT_LT(choose(make_quads(), {}, {0.5f, 0.5f, 100}, 50), 0.6 * tolerance)
        << "displaced towards the camera";
}

TEST(BaseTolerances, are_in_units_of_the_mesh) {
    Affine larger;
    for (int axis = 0; axis < 3; ++axis) larger.rows[axis] = larger.rows[axis] * 4.0f;
    const double tolerance = choose(make_quads(), {}, {0.5f, 0.5f, 100});
    EXPECT_EQ(choose(make_quads(), larger, {2, 2, 400}), tolerance);
    Affine stretched;
    stretched.rows[0] = stretched.rows[0] * 4.0f;
    EXPECT_LT(choose(make_quads(), stretched, {2, 0.5f, 100}), 0.5 * tolerance)
        << "one unit is four in the world";
}

TEST(BaseTolerances, are_those_of_the_nearest_place) {
    Affine far;
    far.translation = {0, 0, -900};
    const std::array places = {far, Affine{}};
    const LevelFieldConfig view = make_view({0.5f, 0.5f, 100});
    EXPECT_EQ(choose_base_tolerance(make_quads(), places, 0, view),
              choose_base_tolerance(make_quads(), std::array{Affine{}}, 0, view));
}

TEST(BaseTolerances, differ_from_face_to_face_of_a_mesh_that_is_close) {
    const std::array places = {Affine{}};
    const BaseTolerance tolerance = choose_base_tolerance(make_quads(), places, 0, make_view({-2, 0.5f, 0}));
    ASSERT_EQ(tolerance.of_faces.size(), 2u);
    EXPECT_GT(tolerance.of_face(1), 4 * tolerance.of_face(0));
    // From within a face the smallest is taken.
    EXPECT_LT(choose(make_quads(), {}, {0.5f, 0.5f, 0}), 1e-12);
}

TEST(BaseTolerances, pass_over_indices_that_are_refused_later) {
    Mesh mesh = make_quads();
    mesh.position_indices[5] = 1000;
    mesh.face_sizes.push_back(4);
    const std::array places = {Affine{}};
    EXPECT_EQ(choose_base_tolerance(mesh, places, 0, make_view({-2, 0.5f, 0})).of_faces.size(), 3u);
}

TEST(BaseTolerances, are_finite_without_a_place) {
    const BaseTolerance tolerance = choose_base_tolerance(make_quads(), {}, 0, make_view({0, 0, 5}));
    EXPECT_TRUE(std::isfinite(tolerance.of_face(0)));
}

TEST(BaseTolerances, stay_while_the_camera_moves_a_little) {
    const std::array places = {Affine{}};
    int changes = 0;
    BaseTolerance before = choose_base_tolerance(make_quads(), places, 0, make_view({0.5f, 0.5f, 100}));
    for (int step = 1; step <= 20; ++step) {
        const BaseTolerance now =
            choose_base_tolerance(make_quads(), places, 0, make_view({0.5f, 0.5f, 100 + 0.5f * float(step)}));
        changes += !(now == before);
        before = now;
    }
    EXPECT_LE(changes, 1);
}

} // namespace

} // namespace relief
