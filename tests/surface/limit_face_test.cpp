// Limit faces of meshes that are not refined: positions beside OpenSubdiv's, uvs beside those of finer
// levels.
#include <gtest/gtest.h>

#include <cmath>

#include "surface/limit_reference.h"
#include "surface/mesh/subdivision_mesh.h"
#include "surface/smooth_shapes.h"

namespace relief {

namespace {

constexpr double kPlaces[] = {0, 0.004, 0.11, 0.25, 0.5, 0.63, 0.97, 1};

TEST(LimitFace, positions_and_derivatives_are_those_of_opensubdiv) {
    const Mesh mesh = test::make_fine_cube();
    const Polygons polygons = make_polygons(mesh, Welding::joined_points);
    const SubdivisionMesh source(polygons, mesh.subdivision);
    const test::LimitReference reference(mesh);
    for (uint32_t number = 0; number < polygons.face_count(); ++number) {
        const LimitFace face = source.make_face(number);
        const uint32_t parts = polygons.face_size(number) == 4 ? 1 : polygons.face_size(number);
        for (uint32_t part = 0; part < parts; ++part)
            for (const double u : kPlaces)
                for (const double v : kPlaces) {
                    const test::ReferencePoint wanted = reference.evaluate(number, part, u, v);
                    const LimitSample found = face.evaluate(part, u, v);
                    // OpenSubdiv isolates the corners of polygons to a depth only.
                    EXPECT_LT(compute_length(found.position - wanted.position), parts == 1 ? 1e-6 : 3e-5)
                        << number;
                    const Vec3d normal = normalize_double(cross(found.du, found.dv));
                    EXPECT_LT(compute_length(normal - wanted.normal), wanted.sine > 0.1 ? 1e-3 : 2.0)
                        << number << " " << u << " " << v;
                    EXPECT_EQ(face.evaluate_position(part, u, v), found.position);
                }
    }
}

TEST(LimitFace, is_bicubic_in_cells_apart_from_irregular_corners) {
    const Mesh mesh = test::make_fine_cube();
    const Polygons polygons = make_polygons(mesh, Welding::joined_points);
    const SubdivisionMesh source(polygons, mesh.subdivision);
    const auto make_place = [](uint32_t face, double low, double high) {
        return QuadPlace{face, 0, {{{low, low}, {high, low}, {high, high}, {low, high}}}};
    };
    // Corner 0 of the first face is a corner of the cube, face 63 is in the middle of one of its sides.
    const LimitFace corner = source.make_face(0), middle = source.make_face(63);
    EXPECT_TRUE(middle.is_bicubic());
    EXPECT_TRUE(middle.is_bicubic_within(make_place(63, 0, 1)));
    EXPECT_FALSE(corner.is_bicubic());
    EXPECT_FALSE(corner.is_bicubic_within(make_place(0, 0, 1)));
    EXPECT_FALSE(corner.is_bicubic_within(make_place(0, 0, 0.25)));
    EXPECT_FALSE(corner.is_bicubic_within(make_place(0, 0.25, 0.75)));
    EXPECT_TRUE(corner.is_bicubic_within(make_place(0, 0.5, 1)));
    EXPECT_TRUE(corner.is_bicubic_within(make_place(0, 0.25, 0.5)));
}

TEST(LimitFace, derivatives_are_the_slopes_of_positions) {
    const Mesh mesh = test::make_fine_cube();
    const Polygons polygons = make_polygons(mesh, Welding::joined_points);
    const SubdivisionMesh source(polygons, mesh.subdivision);
    constexpr double kStep = 1e-4;
    for (uint32_t number = 0; number < polygons.face_count(); ++number) {
        if (polygons.face_size(number) != 4) continue;
        const LimitFace face = source.make_face(number);
        for (const double u : {0.07, 0.33, 0.81})
            for (const double v : {0.09, 0.4, 0.9}) {
                const auto at = [&](double du, double dv) {
                    return face.evaluate_position(0, u + du * kStep, v + dv * kStep);
                };
                const LimitSample sample = face.evaluate_with_twist(0, u, v);
                EXPECT_LT(compute_length((at(1, 0) - at(-1, 0)) * (0.5 / kStep) - sample.du), 1e-4) << number;
                EXPECT_LT(compute_length((at(0, 1) - at(0, -1)) * (0.5 / kStep) - sample.dv), 1e-4) << number;
                const Vec3d twist =
                    (at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) * (0.25 / (kStep * kStep));
                EXPECT_LT(compute_length(twist - sample.duv), 2e-3) << number;
            }
    }
}

TEST(LimitFace, uvs_beside_seams_are_those_of_a_finer_level) {
    Mesh mesh = test::make_fine_cube();
    const Polygons polygons = make_polygons(mesh, Welding::joined_points);
    const SubdivisionMesh source(polygons, mesh.subdivision);
    mesh.subdivision.level = 3;
    SubdivisionMesh finer(polygons, mesh.subdivision);
    const RefinedMesh refined = finer.refine("mesh");
    ASSERT_EQ(refined.uvs.size(), refined.points.size());
    double most_bent = 0;
    for (uint32_t quad = 0; quad < refined.quad_count(); ++quad) {
        const QuadPlace& place = refined.places[quad];
        const LimitFace face = source.make_uv_face(place.face, 0);
        for (size_t k = 0; k < 4; ++k) {
            const Vec3d uv = face.evaluate_position(place.part, place.corners[k].x, place.corners[k].y);
            EXPECT_NEAR(uv.x, double(refined.uvs[quad][k].x), 2e-6) << place.face << " corner " << k;
            EXPECT_NEAR(uv.y, double(refined.uvs[quad][k].y), 2e-6) << place.face << " corner " << k;
        }
        const auto corner = [&](size_t k) { return double(polygons.uvs[polygons.starts[place.face] + k].x); };
        most_bent = std::max(most_bent, std::fabs(double(refined.uvs[quad][0].x) - corner(0)));
    }
    EXPECT_GT(most_bent, 0.01) << "uvs are smoothed at all";
}

} // namespace

} // namespace relief
