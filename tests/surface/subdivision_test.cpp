#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <random>

#include "math/box.h"
#include "surface/limit_reference.h"
#include "surface/mesh/irregular_points.h"
#include "surface/mesh/limit_patches.h"
#include "surface/mesh/subdivide.h"
#include "surface/patch/bicubic.h"
#include "surface/patch/patch_samples.h"
#include "surface/shared_sides.h"
#include "surface/smooth_shapes.h"

namespace relief {

namespace {

using test::Shape;

constexpr Shape kOpenShapes[] = {Shape::grid,         Shape::sharp_corner_grid,
                                 Shape::crossed_grid, Shape::changing_grid,
                                 Shape::pole,         Shape::sharp_point_grid};

/// What make_surface goes through, with the places of the patches on the mesh.
struct Subdivided {
    explicit Subdivided(const Mesh& mesh)
        : polygons(make_polygons(mesh, Welding::joined_points)),
          source(polygons, mesh.subdivision),
          refined(make_refined(source)),
          patches(make_limit_patches(source, refined)) {}

    test::ReferencePoint find_limit(const test::LimitReference& reference, uint32_t quad, double x,
                                    double y) const {
        const QuadPlace& place = refined.places[quad];
        const std::array<Vec2<double>, 4>& c = place.corners;
        const Vec2<double> at = (c[0] * (1 - x) + c[1] * x) * (1 - y) + (c[3] * (1 - x) + c[2] * x) * y;
        return reference.evaluate(place.face, place.part, at.x, at.y);
    }
    BicubicBase base(uint32_t quad) const {
        const auto& points = refined.points[quad];
        return BicubicBase({patches.positions[points[0]], patches.positions[points[1]],
                            patches.positions[points[2]], patches.positions[points[3]]},
                           patches.controls[quad]);
    }
    /// Not fitted.
    bool is_exact(uint32_t quad) const {
        const std::array<Vec2<double>, 4>& c = refined.places[quad].corners;
        for (size_t k = 0; k < 4; ++k) {
            const Vec2<double> side = c[(k + 1) % 4] - c[k];
            if (!refined.is_regular[refined.points[quad][k]] || (side.x != 0 && side.y != 0) ||
                refined.is_bent[refined.edges[quad][k]])
                return false;
        }
        return true;
    }
    static RefinedMesh make_refined(SubdivisionMesh& source) {
        RefinedMesh refined = source.refine("mesh");
        cut_at_irregular_points(refined, kIsolationDepth);
        return refined;
    }

    Polygons polygons;
    SubdivisionMesh source;
    RefinedMesh refined;
    LimitPatches patches;
};

double distance(const Vec3f& a, const Vec3<double>& b) {
    const Vec3<double> d = Vec3<double>{a.x, a.y, a.z} - b;
    return std::sqrt(dot(d, d));
}

double find_diagonal(const Mesh& mesh) {
    Box box;
    for (const Vec3f& p : mesh.positions) box.extend(p);
    return length(box.extent());
}

class SubdivisionTest : public testing::TestWithParam<Shape> {};

TEST_P(SubdivisionTest, points_and_normals_lie_on_the_limit_surface) {
    const Mesh mesh = test::make_shape(GetParam());
    const Subdivided subdivided(mesh);
    const test::LimitReference reference(mesh);
    for (uint32_t quad = 0; quad < subdivided.refined.quad_count(); ++quad)
        for (size_t k = 0; k < 4; ++k) {
            const test::ReferencePoint wanted =
                subdivided.find_limit(reference, quad, k == 1 || k == 2, k >= 2);
            EXPECT_LT(
                distance(subdivided.patches.positions[subdivided.refined.points[quad][k]], wanted.position),
                5e-6);
            const Vec3f& normal = subdivided.patches.corner_normals[quad][k];
            if (wanted.sine > 0.1)
                EXPECT_LT(distance(normal, wanted.normal), 1e-4) << quad << " corner " << k;
        }
}

TEST_P(SubdivisionTest, patches_equal_the_limit_surface_at_random_points) {
    Mesh mesh = test::make_shape(GetParam());
    // The cages are of few faces, which are large beside their diagonal.
    mesh.subdivision.level = GetParam() == Shape::tangled_cube ? 5 : 4;
    const Subdivided subdivided(mesh);
    const test::LimitReference reference(mesh);
    const double diagonal = find_diagonal(mesh);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0, 1);
    double worst_exact = 0, worst_fitted = 0;
    int exact_count = 0;
    for (uint32_t quad = 0; quad < subdivided.refined.quad_count(); ++quad)
        for (int sample = 0; sample < 20; ++sample) {
            const float x = unit(random), y = unit(random);
            const test::ReferencePoint wanted = subdivided.find_limit(reference, quad, double(x), double(y));
            const Vec3f found = subdivided.base(quad).evaluate(x, y);
            if (subdivided.is_exact(quad)) {
                worst_exact = std::max(worst_exact, distance(found, wanted.position));
                ++exact_count;
                continue;
            }
            // Along the surface the fit may lag behind; off the surface it may not be.
            const Vec3<double> d = Vec3<double>{found.x, found.y, found.z} - wanted.position;
            worst_fitted = std::max(worst_fitted, std::fabs(dot(d, wanted.normal)));
        }
    EXPECT_GT(exact_count, 0);
    EXPECT_LT(worst_exact, 1e-6 * diagonal);
    EXPECT_LT(worst_fitted, 1e-5 * diagonal);
}

TEST_P(SubdivisionTest, cut_quads_share_their_sides) {
    for (const int level : {0, 1, 2, 3, 4}) {
        Mesh mesh = test::make_shape(GetParam());
        mesh.subdivision.level = level;
        const Subdivided subdivided(mesh);
        const RefinedMesh& refined = subdivided.refined;
        const bool has_boundary = test::expect_shared_sides(refined) > 0;
        EXPECT_EQ(has_boundary, std::count(std::begin(kOpenShapes), std::end(kOpenShapes), GetParam()) == 1);
        const bool has_semi_sharp = !mesh.creases.empty() && GetParam() != Shape::creased_cube;
        if (level < 2 || level > 3 || !has_semi_sharp) continue;
        mesh.subdivision.creases = CreaseRule::ignore;
        EXPECT_GT(refined.quad_count(), Subdivided(mesh).refined.quad_count()) << "no crease was cut";
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, SubdivisionTest, testing::ValuesIn(test::kAllShapes));

} // namespace

} // namespace relief
