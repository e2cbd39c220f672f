// Automatic subdivision levels: closed meshes of few quads, within the tolerance of the limit surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "surface/limit_reference.h"
#include "surface/map/displacement_map.h"
#include "surface/mesh/adaptive_cage.h"
#include "surface/mesh/edge_splits.h"
#include "surface/mesh/limit_patches.h"
#include "surface/mesh/patch_fit.h"
#include "surface/patch/bicubic.h"
#include "surface/patch/patch_samples.h"
#include "surface/shared_sides.h"
#include "surface/smooth_shapes.h"

namespace relief {

namespace {

using test::Shape;

/// A mesh with patches as near as 2^(exponent / 2).
struct Adapted {
    Adapted(const Mesh& mesh, int exponent, BasePatches patches_wanted = BasePatches::bicubic,
            const DisplacementChange* change = nullptr)
        : Adapted(mesh, BaseTolerance{exponent, {}}, patches_wanted, change) {}

    Adapted(const Mesh& mesh, const BaseTolerance& tolerance, BasePatches patches_wanted,
            const DisplacementChange* change)
        : polygons(make_polygons(mesh, Welding::joined_points)),
          source(polygons, mesh.subdivision),
          refined(refine_adaptively(source, polygons, {patches_wanted, tolerance, change, false}, reserve)),
          patches(make_limit_patches(source, refined)) {}

    BicubicBase base(uint32_t quad) const {
        const auto& points = refined.points[quad];
        return BicubicBase({patches.positions[points[0]], patches.positions[points[1]],
                            patches.positions[points[2]], patches.positions[points[3]]},
                           patches.controls[quad]);
    }

    Polygons polygons;
    SubdivisionMesh source;
    BaseReserve reserve;
    RefinedMesh refined;
    LimitPatches patches;
};

/// A torus of n x n quads, all of them regular, with seams in its uvs at 0 and 1.
Mesh make_torus(uint32_t n) {
    Mesh mesh;
    mesh.name = "torus";
    for (uint32_t j = 0; j < n; ++j)
        for (uint32_t i = 0; i < n; ++i) {
            const double a = 2 * std::numbers::pi * i / n, b = 2 * std::numbers::pi * j / n;
            const double r = 2 + std::cos(b);
            mesh.positions.push_back({float(r * std::cos(a)), float(r * std::sin(a)), float(std::sin(b))});
        }
    for (uint32_t j = 0; j < n; ++j)
        for (uint32_t i = 0; i < n; ++i) {
            const uint32_t right = (i + 1) % n, up = (j + 1) % n;
            const auto uv = [&](uint32_t x, uint32_t y) { return Vec2f{float(x) / n, float(y) / n}; };
            test::add_face(mesh, {j * n + i, j * n + right, up * n + right, up * n + i},
                           {uv(i, j), uv(i + 1, j), uv(i + 1, j + 1), uv(i, j + 1)});
        }
    mesh.subdivision.scheme = SubdivisionScheme::catmark;
    return mesh;
}

Mesh make_automatic(Shape shape) {
    Mesh mesh = test::make_shape(shape);
    mesh.subdivision.level = kAutoSubdivisionLevel;
    return mesh;
}

/// Distance of a point from the limit surface of a face, looked for around `at` by steps that get smaller.
double find_distance(const test::LimitReference& reference, const QuadPlace& place, Vec2<double> at,
                     const Vec3d& p) {
    const auto measure = [&](const Vec2<double>& there) {
        return compute_length(reference.evaluate(place.face, place.part, there.x, there.y).position - p);
    };
    double nearest = measure(at);
    for (double step = 0.1; step > 1e-4;) {
        bool is_nearer = false;
        for (const Vec2<double>& way :
             {Vec2<double>{1, 0}, Vec2<double>{-1, 0}, Vec2<double>{0, 1}, Vec2<double>{0, -1}}) {
            const Vec2<double> there{std::clamp(at.x + way.x * step, 0.0, 1.0),
                                     std::clamp(at.y + way.y * step, 0.0, 1.0)};
            const double distance = measure(there);
            if (distance >= nearest) continue;
            nearest = distance, at = there, is_nearer = true;
        }
        if (!is_nearer) step /= 2;
    }
    return nearest;
}

class AdaptiveSubdivision : public testing::TestWithParam<Shape> {};

TEST_P(AdaptiveSubdivision, quads_share_their_sides) {
    for (const int exponent : {4, -8, -16}) {
        const Adapted adapted(make_automatic(GetParam()), exponent);
        test::expect_shared_sides(adapted.refined);
    }
}

TEST_P(AdaptiveSubdivision, patches_are_within_the_tolerance_of_the_limit_surface) {
    const Mesh mesh = make_automatic(GetParam());
    const test::LimitReference reference(mesh);
    size_t quads_before = 0;
    for (const int exponent : {-8, -14}) {
        const Adapted adapted(mesh, exponent);
        std::mt19937 random(3);
        std::uniform_real_distribution<float> unit(0, 1);
        double worst = 0;
        for (uint32_t quad = 0; quad < adapted.refined.quad_count(); ++quad) {
            const QuadPlace& place = adapted.refined.places[quad];
            const std::array<Vec2<double>, 4>& c = place.corners;
            for (int sample = 0; sample < 16; ++sample) {
                const float x = unit(random), y = unit(random);
                const double u = double(x), v = double(y);
                const Vec2<double> at =
                    (c[0] * (1 - u) + c[1] * u) * (1 - v) + (c[3] * (1 - u) + c[2] * u) * v;
                const Vec3d p = to_double(adapted.base(quad).evaluate(x, y));
                const double distance = find_distance(reference, place, at, p);
                if (!(distance <= worst)) worst = distance; // NaN counts, too
            }
        }
        EXPECT_LT(worst, std::exp2(0.5 * exponent)) << "exponent " << exponent;
        EXPECT_GE(adapted.refined.quad_count(), quads_before) << "a smaller tolerance needs more quads";
        quads_before = adapted.refined.quad_count();
    }
}

TEST_P(AdaptiveSubdivision, plain_quads_are_within_the_tolerance_of_the_limit_surface) {
    const Mesh mesh = make_automatic(GetParam());
    const test::LimitReference reference(mesh);
    const int exponent = -10;
    const Adapted adapted(mesh, exponent, BasePatches::bilinear);
    double worst = 0;
    for (uint32_t quad = 0; quad < adapted.refined.quad_count(); ++quad) {
        const QuadPlace& place = adapted.refined.places[quad];
        const Vec2<double> at =
            (place.corners[0] + place.corners[1] + place.corners[2] + place.corners[3]) * 0.25;
        Vec3d middle{};
        for (const uint32_t point : adapted.refined.points[quad])
            middle = middle + to_double(adapted.patches.positions[point]) * 0.25;
        const test::ReferencePoint wanted = reference.evaluate(place.face, place.part, at.x, at.y);
        worst = std::max(worst, std::fabs(dot(middle - wanted.position, wanted.normal)));
    }
    // Faces stop to be cut at 1/64 of their sides: a crease of sharpness 5 may be narrower.
    EXPECT_LT(worst, 2 * std::exp2(0.5 * exponent));
}

INSTANTIATE_TEST_SUITE_P(Shapes, AdaptiveSubdivision, testing::ValuesIn(test::kAllShapes));
INSTANTIATE_TEST_SUITE_P(Fine, AdaptiveSubdivision, testing::Values(Shape::fine_cube));

TEST(AutomaticLevels, regular_faces_stay_whole) {
    const Adapted adapted(make_torus(12), -24);
    EXPECT_EQ(adapted.refined.quad_count(), 144u);
    EXPECT_FALSE(adapted.reserve.is_cut);
    const Adapted coarse(test::make_shape(Shape::cube), 8);
    EXPECT_EQ(coarse.refined.quad_count(), 6u);
}

TEST(AutomaticLevels, polygons_are_cut_alone) {
    // A level for all would make 16 quads of the pyramid, and four times as many of any mesh around it.
    Mesh mesh = make_torus(12);
    mesh.face_sizes.back() = 3;
    mesh.position_indices.pop_back(), mesh.uv_indices.pop_back();
    const uint32_t corner = uint32_t(mesh.position_indices.size()) - 3;
    test::add_face(mesh, {mesh.position_indices[corner], mesh.position_indices[corner + 2], 11},
                   {{0, 0}, {1, 0}, {0, 1}});
    const Adapted adapted(mesh, 8);
    EXPECT_GT(adapted.refined.quad_count(), 144u);
    EXPECT_LT(adapted.refined.quad_count(), 180u);
}

TEST(AutomaticLevels, reserves_tell_which_tolerances_give_the_same_base) {
    const Mesh mesh = make_automatic(Shape::cube);
    const Adapted coarse(mesh, 2);
    ASSERT_FALSE(coarse.reserve.is_cut);
    const int last = 2 - coarse.reserve.spare_steps;
    EXPECT_EQ(Adapted(mesh, last).refined.quad_count(), coarse.refined.quad_count());
    EXPECT_GT(Adapted(mesh, last - 1).refined.quad_count(), coarse.refined.quad_count());
    EXPECT_TRUE(is_same_base({2, {}}, {last, {}}, coarse.reserve));
    EXPECT_FALSE(is_same_base({2, {}}, {last - 1, {}}, coarse.reserve));
    EXPECT_FALSE(is_same_base({2, {}}, {3, {}}, {0, true}));
    EXPECT_TRUE(is_same_base({2, {}}, {0, {2, 1, 5}}, {1, false}));
    EXPECT_FALSE(is_same_base({2, {}}, {0, {2, 0, 5}}, {1, false}));
}

/// The displacement of a map that grows with u and v by `slope` per uv, sampled finely.
DisplacementMap make_sloped_map(float slope, PyramidCache& pyramids) {
    constexpr uint32_t kSize = 256;
    auto texels = test::make_constant(kSize, kSize, {0, 0, 0});
    for (uint32_t y = 0; y < kSize; ++y)
        for (uint32_t x = 0; x < kSize; ++x)
            texels->floats[4 * (y * kSize + x) + 2] = slope * float(x) / kSize,
                                                 texels->floats[4 * (y * kSize + x) + 1] =
                                                     -slope * float(y) / kSize;
    Displacement displacement = test::make_displacement(std::move(texels));
    displacement.space = DisplacementSpace::object;
    displacement.wrap = WrapMode::clamp;
    return make_displacement_map(displacement, {}, pyramids);
}

TEST(AutomaticLevels, patches_beside_seams_have_the_limit_uvs_within_the_tolerance) {
    // Islands lie side by side in u; the map that they read is the same for all.
    Mesh mesh = test::make_fine_cube();
    for (Vec2f& uv : mesh.uvs) uv.x = std::fmod(uv.x, 1.0f);
    PyramidCache pyramids;
    constexpr float kSlope = 8; // a uv of 1 is about 3.3 long
    const DisplacementMap map = make_sloped_map(kSlope, pyramids);
    const DisplacementChange change(map, false);
    for (const int exponent : {-8, -11}) {
        const Adapted adapted(mesh, exponent, BasePatches::bicubic, &change);
        const double tolerance = std::exp2(exponent / 2.0);
        double worst = 0;
        for (uint32_t quad = 0; quad < adapted.refined.quad_count(); ++quad) {
            const QuadPlace& place = adapted.refined.places[quad];
            const LimitFace face = adapted.source.make_face(place.face),
                            uv_face = adapted.source.make_uv_face(place.face, 0);
            const UvMatching matching(uv_face, place, adapted.refined.uvs[quad]);
            const BicubicBase base = adapted.base(quad);
            for (const float x : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f})
                for (const float y : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f}) {
                    const UvMatching::Match match = matching.match(double(x), double(y));
                    const std::array<Vec2<double>, 4>& c = place.corners;
                    const Vec2<double> at =
                        (c[0] * (1 - match.place.x) + c[1] * match.place.x) * (1 - match.place.y) +
                        (c[3] * (1 - match.place.x) + c[2] * match.place.x) * match.place.y;
                    const Vec3d off =
                        to_double(base.evaluate(x, y)) - face.evaluate_position(place.part, at.x, at.y);
                    // How far the displacement is from where it belongs.
                    worst = std::max(worst, compute_length(off) * kSlope / 3.3);
                }
        }
        EXPECT_LT(worst, tolerance) << exponent << ", " << adapted.refined.quad_count() << " quads";
        EXPECT_GT(worst, 0.1 * tolerance);
        EXPECT_LT(adapted.refined.quad_count(), 20000u);
    }
}

TEST(DisplacementChange, is_bounded_by_blocks_only_where_that_is_enough) {
    PyramidCache pyramids;
    auto texels = test::make_constant(64, 64, {0, 0, 0});
    texels->floats[4 * (20 * 64 + 20)] = 1; // in a block that the quad touches, away from the quad
    texels->floats[4 * (24 * 64 + 25)] = 0.1f;
    Displacement displacement = test::make_displacement(std::move(texels));
    displacement.space = DisplacementSpace::object;
    const DisplacementMap map = make_displacement_map(displacement, {}, pyramids);
    const DisplacementChange change(map, false);
    const auto v = [](float row) { return 1 - row / 64; };
    const float left = 23.0f / 64, right = 27.0f / 64;
    const std::array<Vec2f, 4> uvs = {{{left, v(27)}, {right, v(27)}, {right, v(23)}, {left, v(23)}}};
    const Vec2<double> error{1e-3, 1e-3};
    const double exact = change.find_change(uvs, error), bound = change.find_change(uvs, error, 1e9);
    EXPECT_NEAR(exact, 0.1 * 2 * 64e-3, 1e-6);
    EXPECT_NEAR(bound, 2 * 64e-3, 1e-6);
    EXPECT_EQ(change.find_change(uvs, error, 0.5 * bound), exact);
    EXPECT_EQ(change.find_change(uvs, error, 2 * bound), bound);
}

TEST(AutomaticLevels, quads_that_are_cut_beside_exact_ones_have_the_curves_of_their_sides) {
    // Frames turn, so that faces with a small tolerance are cut; uvs are straight, so that others stay exact.
    const Mesh mesh = make_torus(16);
    PyramidCache pyramids;
    Displacement displacement = test::make_displacement(test::make_constant(4, 4, {0, 0, 0.3f}));
    displacement.space = DisplacementSpace::tangent;
    const DisplacementMap map = make_displacement_map(displacement, {}, pyramids);
    const DisplacementChange change(map, false);
    std::mt19937 random(5);
    for (int turn = 0; turn < 8; ++turn) {
        BaseTolerance tolerance{0, std::vector<int8_t>(256, 4)};
        for (int8_t& of_face : tolerance.of_faces)
            if (random() % 16 == 0) of_face = -16;
        const Adapted adapted(mesh, tolerance, BasePatches::bicubic, &change);
        EXPECT_GT(adapted.refined.quad_count(), 256u);
        for (uint32_t quad = 0; quad < adapted.refined.quad_count(); ++quad)
            // The torus stays away from its middle, where the points of a missing curve would be.
            for (const Vec3f& control : adapted.patches.controls[quad])
                ASSERT_GT(length(control), 0.5f) << turn << ", quad " << quad;
    }
}

TEST(AutomaticLevels, odd_quads_are_joined_with_each_other_or_with_a_boundary) {
    for (const Shape shape : {Shape::cube, Shape::grid}) {
        const Mesh mesh = make_automatic(shape);
        const Polygons polygons = make_polygons(mesh, Welding::joined_points);
        const Cage cage = SubdivisionMesh(polygons, mesh.subdivision).cage();
        for (size_t first = 0; first < cage.is_sharp.size(); ++first) {
            std::vector<uint8_t> is_split(cage.is_sharp.size());
            is_split[first] = 1;
            make_splits_even(cage, is_split);
            EXPECT_EQ(is_split[first], 1);
            for (uint32_t face = 0; face < cage.face_count(); ++face) {
                int count = 0;
                for (uint32_t k = 0; k < 4; ++k) count += is_split[cage.edges[4 * face + k]];
                EXPECT_EQ(count % 2, 0) << int(shape) << " face " << face;
            }
        }
    }
}

/// A torus whose uvs are far from even.
Mesh make_warped_torus(uint32_t n, float warp) {
    Mesh mesh = make_torus(n);
    for (Vec2f& uv : mesh.uvs)
        uv = {uv.x + warp * std::sin(6 * uv.y), uv.y + warp * std::cos(5 * uv.x) - 0.5f * warp};
    return mesh;
}

TEST(AutomaticLevels, patches_have_the_limit_uvs_at_their_points) {
    const Mesh mesh = make_warped_torus(8, 0.02f);
    const Polygons polygons = make_polygons(mesh, Welding::joined_points);
    const SubdivisionMesh source(polygons, mesh.subdivision);
    BaseReserve reserve;
    const RefinedMesh refined =
        refine_adaptively(source, polygons, {BasePatches::bicubic, {8, {}}, nullptr, false}, reserve);
    double fitted = 0, exact = 0;
    for (uint32_t quad = 0; quad < refined.quad_count(); ++quad) {
        const LimitFace face = source.make_face(quad), uv_face = source.make_uv_face(quad, 0);
        PatchFit to_uvs(face, refined, quad), plain(face, refined, quad);
        plain.fit();
        const UvMatching matching(uv_face, refined.places[quad], refined.uvs[quad]);
        for (size_t k = 0; k < 4; ++k) to_uvs.take_side(k, to_uvs.fit_side_to_uvs(k, matching, true));
        to_uvs.fit_inside_to_uvs(matching);
        const auto measure = [&](const PatchFit& fit, float x, float y) {
            InnerControls controls;
            std::array<Vec3f, 4> corners;
            for (size_t k = 0; k < 12; ++k) controls[k] = to_float(fit.controls()[k]);
            for (size_t k = 0; k < 4; ++k) corners[k] = to_float(fit.corner(k));
            const Vec2<double> place = matching.match(double(x), double(y)).place;
            return compute_length(to_double(BicubicBase(corners, controls).evaluate(x, y)) -
                                  face.evaluate_position(0, place.x, place.y));
        };
        for (const float x : {0.1f, 0.3f, 0.6f, 0.9f})
            for (const float y : {0.2f, 0.5f, 0.8f}) {
                fitted = std::max(fitted, measure(to_uvs, x, y));
                exact = std::max(exact, measure(plain, x, y));
            }
    }
    EXPECT_GT(exact, 0.01);
    EXPECT_LT(fitted, 0.6 * exact);
}

TEST(AutomaticLevels, faces_are_cut_where_the_map_would_lie_elsewhere) {
    SurfaceContext context;
    context.tolerance = BaseTolerance{find_tolerance_exponent(1e-2), {}};
    const auto count = [&](float warp, float height, DisplacementSpace space) {
        Displacement displacement = test::make_displacement(test::make_noise(24, 24, height, 5));
        displacement.space = space;
        return make_surface(make_warped_torus(8, warp), &displacement, context).patch_count();
    };
    EXPECT_EQ(count(0, 0.3f, DisplacementSpace::object), 64u) << "uvs are straight";
    EXPECT_EQ(count(0.02f, 1e-4f, DisplacementSpace::object), 64u) << "nothing is displaced far";
    EXPECT_GT(count(0.03f, 1, DisplacementSpace::object), 64u);
    EXPECT_GT(count(0, 0.3f, DisplacementSpace::tangent), 64u) << "frames turn";
    EXPECT_EQ(count(0, 1e-3f, DisplacementSpace::tangent), 64u);
}

} // namespace

} // namespace relief
