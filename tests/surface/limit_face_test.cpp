// Limit faces of meshes that are not refined: positions beside OpenSubdiv's, uvs beside those of finer
// levels.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "surface/limit_reference.h"
#include "surface/mesh/subdivision_mesh.h"
#include "surface/smooth_shapes.h"

namespace relief {

namespace {

using test::Shape;

constexpr double kPlaces[] = {0.004, 0.11, 0.25, 0.5, 0.63, 0.97};

/// A closed cube of 5 x 5 quads a side with smooth uvs in one island a side, whose corners are extraordinary
/// points, and a quad of it cut into triangles.
Mesh make_fine_cube() {
    constexpr int kSide = 5;
    Mesh mesh;
    mesh.name = "fine cube";
    for (int side = 0; side < 6; ++side)
        for (int j = 0; j < kSide; ++j)
            for (int i = 0; i < kSide; ++i) {
                std::vector<uint32_t> points;
                std::vector<Vec2f> uvs;
                for (const auto& [x, y] : {std::pair{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}) {
                    const float a = 2.0f * float(x) / kSide - 1, b = 2.0f * float(y) / kSide - 1;
                    const Vec3f at[] = {{a, b, 1}, {b, a, -1}, {1, a, b}, {-1, b, a}, {b, 1, a}, {a, -1, b}};
                    points.push_back(uint32_t(mesh.positions.size()));
                    mesh.positions.push_back(at[side]);
                    // Curved, and each side on its own.
                    uvs.push_back({float(side) + 0.4f + 0.3f * a + 0.05f * b * b,
                                   0.5f + 0.35f * b + 0.04f * std::sin(3 * a)});
                }
                if (side == 0 && i == 2 && j == 2) {
                    test::add_face(mesh, {points[0], points[1], points[2]}, {uvs[0], uvs[1], uvs[2]});
                    test::add_face(mesh, {points[0], points[2], points[3]}, {uvs[0], uvs[2], uvs[3]});
                } else {
                    test::add_face(mesh, points, uvs);
                }
            }
    mesh.subdivision.scheme = SubdivisionScheme::catmark;
    return mesh;
}

/// Like the mesh, with the points that make_polygons() joins joined.
Mesh join_points(const Mesh& mesh, const Polygons& polygons) {
    Mesh joined = mesh;
    joined.positions = polygons.positions;
    joined.position_indices = polygons.points;
    return joined;
}

TEST(LimitFace, positions_and_derivatives_are_those_of_opensubdiv) {
    const Mesh mesh = make_fine_cube();
    const Polygons polygons = make_polygons(mesh, Welding::equal_points);
    const SubdivisionMesh source(polygons, mesh.subdivision);
    const test::LimitReference reference(join_points(mesh, polygons));
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
                    EXPECT_LT(compute_length(normal - wanted.normal), 1e-3) << number << " " << u << " " << v;
                    EXPECT_EQ(face.evaluate_position(part, u, v), found.position);
                }
    }
}

TEST(LimitFace, derivatives_are_the_slopes_of_positions) {
    const Mesh mesh = make_fine_cube();
    const Polygons polygons = make_polygons(mesh, Welding::equal_points);
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
    Mesh mesh = make_fine_cube();
    const Polygons polygons = make_polygons(mesh, Welding::equal_points);
    const SubdivisionMesh source(polygons, mesh.subdivision);
    mesh.subdivision.level = 3;
    SubdivisionMesh finer(polygons, mesh.subdivision);
    const RefinedMesh refined = finer.refine();
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
