// Surfaces over a smooth base: closed, without creases where there are none, inside their boxes.
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "surface/mesh/irregular_points.h"
#include "surface/mesh/uv_outlines.h"
#include "surface/patch/patch_samples.h"
#include "surface/smooth_shapes.h"

namespace relief {

namespace {

using test::catch_message;
using test::Shape;

constexpr Shape kShapes[] = {Shape::cube,         Shape::pyramid,         Shape::grid,
                             Shape::creased_cube, Shape::semi_sharp_cube, Shape::sharp_corner_grid};

Surface make_displaced(const Mesh& mesh, DisplacementSpace space) {
    Displacement displacement = test::make_displacement(test::make_noise(24, 24, 0.1f, 5));
    displacement.space = space;
    return make_surface(mesh, &displacement, {});
}

TEST(SmoothSurface, both_sides_of_every_edge_have_the_same_samples) {
    for (const Shape shape : kShapes)
        for (const DisplacementSpace space : {DisplacementSpace::object, DisplacementSpace::tangent}) {
            const Surface surface = make_displaced(test::make_shape(shape), space);
            ASSERT_FALSE(surface.controls.empty());
            std::map<std::array<uint32_t, 2>, std::vector<Vec3f>> first_seen;
            int shared = 0;
            for (uint32_t patch = 0; patch < surface.patch_count(); ++patch)
                for (int edge = 0; edge < 4; ++edge) {
                    // Patches of different level meet on edges of one level.
                    const PatchLevels levels{uint8_t(3 + patch % 3), {3, 3, 3, 3}};
                    std::vector<Vec3f> points =
                        test::drop_repeats(test::evaluate_edge(surface, patch, levels, edge));
                    const Quad quad = surface.quads[patch];
                    std::array<uint32_t, 2> ends = {surface.dominant(quad.vertex[size_t(edge)]),
                                                    surface.dominant(quad.vertex[size_t(edge + 1) & 3])};
                    if (ends[1] < ends[0]) {
                        std::swap(ends[0], ends[1]);
                        std::reverse(points.begin(), points.end());
                    }
                    const auto [found, is_new] = first_seen.try_emplace(ends, points);
                    if (is_new) continue;
                    ++shared;
                    ASSERT_EQ(found->second, points) << int(shape) << " patch " << patch << " edge " << edge;
                }
            EXPECT_GT(shared, 20);
        }
}

TEST(SmoothSurface, boxes_hold_every_sample) {
    std::mt19937 random(4);
    for (const Shape shape : kShapes)
        for (const DisplacementSpace space : {DisplacementSpace::object, DisplacementSpace::tangent}) {
            Mesh mesh = test::make_shape(shape);
            mesh.subdivision.level = 1;
            if (shape == Shape::grid)
                for (Vec3f& p : mesh.positions) p = p * 1e-3f + Vec3f{1000, -500, 0.1f};
            const Surface surface = make_displaced(mesh, space);
            for (uint32_t patch = 0; patch < surface.patch_count(); ++patch) {
                PatchLevels levels{uint8_t(random() % 6), {}};
                for (uint8_t& edge : levels.edge) edge = uint8_t(random() % (levels.patch + 1u));
                const uint32_t n = 1u << levels.patch, i0 = uint32_t(random() % n),
                               j0 = uint32_t(random() % n);
                const Box box = compute_patch_box(surface, patch);
                const Box tile = compute_tile_box(surface, patch, levels, {i0, j0, i0 + 1, j0 + 1});
                for (uint32_t j = 0; j <= n; ++j)
                    for (uint32_t i = 0; i <= n; ++i) {
                        const Vec3f p = evaluate_vertex(surface, patch, levels, i, j);
                        ASSERT_TRUE(box.contains(p)) << int(shape) << " patch " << patch;
                        if (i >= i0 && i <= i0 + 1 && j >= j0 && j <= j0 + 1) ASSERT_TRUE(tile.contains(p));
                    }
            }
        }
}

/// Largest difference of the shading normals of two patches on the edge between them.
double find_normal_jump(const Surface& surface) {
    using Point = std::array<float, 3>;
    std::map<std::array<Point, 2>, std::vector<Vec3f>> first_seen;
    double worst = 0;
    for (uint32_t patch = 0; patch < surface.patch_count(); ++patch)
        for (int edge = 0; edge < 4; ++edge) {
            const auto point = [&](int corner) {
                const Vec3f& p = surface.position(surface.quads[patch].vertex[size_t(corner & 3)]);
                return Point{p.x, p.y, p.z};
            };
            std::array<Point, 2> ends = {point(edge), point(edge + 1)};
            std::vector<Vec3f> normals;
            for (int k = 1; k < 8; ++k) {
                const float s = float(ends[0] < ends[1] ? k : 8 - k) / 8;
                const float u = edge == 0 ? s : edge == 1 ? 1 : edge == 2 ? 1 - s : 0;
                const float v = edge == 0 ? 0 : edge == 1 ? s : edge == 2 ? 1 : 1 - s;
                normals.push_back(compute_shading_normal(surface, patch, 4, u, v));
            }
            if (ends[1] < ends[0]) std::swap(ends[0], ends[1]);
            const auto [found, is_new] = first_seen.try_emplace(ends, normals);
            for (size_t k = 0; k < normals.size(); ++k)
                worst = std::max(worst, double(length(found->second[k] - normals[k])));
        }
    return worst;
}

TEST(SmoothSurface, has_no_crease_at_irregular_points) {
    for (const Shape shape : {Shape::cube, Shape::pyramid, Shape::semi_sharp_cube}) {
        const Mesh mesh = test::make_shape(shape);
        const Displacement flat = test::make_displacement(test::make_constant(4, 4, {0, 0, 0}));
        EXPECT_LT(find_normal_jump(make_surface(mesh, &flat, {})), 1e-5) << int(shape);
        EXPECT_LT(find_normal_jump(make_surface(mesh, nullptr, {})), 1e-5) << int(shape);
    }
}

TEST(SmoothSurface, a_crease_stays_sharp_on_a_plain_surface) {
    EXPECT_GT(find_normal_jump(make_surface(test::make_shape(Shape::creased_cube), nullptr, {})), 0.5);
    Mesh ignored = test::make_shape(Shape::creased_cube);
    ignored.subdivision.creases = CreaseRule::ignore;
    EXPECT_LT(find_normal_jump(make_surface(ignored, nullptr, {})), 1e-5);
}

TEST(SmoothSurface, makes_as_many_patches_as_the_level_says) {
    Mesh mesh = test::make_shape(Shape::cube);
    for (const int level : {0, 1, 3}) {
        mesh.subdivision.level = level;
        EXPECT_EQ(make_surface(mesh, nullptr, {}).patch_count(), 6u << 2 * level);
    }
    // A quad and four triangles are 16 quads after one step, which they need.
    mesh = test::make_shape(Shape::pyramid);
    for (const int level : {0, 1, 2}) {
        mesh.subdivision.level = level;
        EXPECT_EQ(make_surface(mesh, nullptr, {}).patch_count(), level == 2 ? 64u : 16u);
    }
}

TEST(SmoothSurface, bicubic_patches_are_cut_around_irregular_points) {
    // Eight corners with three quads each, of which every one becomes two more at every ring, two rings a
    // step.
    Mesh mesh = test::make_shape(Shape::cube);
    EXPECT_EQ(make_displaced(mesh, DisplacementSpace::object).patch_count(),
              96u + 8 * 3 * 2 * 2 * kIsolationDepth);
    // Corners of a cube share their quads: none is alone.
    mesh.subdivision.level = 0;
    EXPECT_EQ(make_displaced(mesh, DisplacementSpace::object).patch_count(), 6u);
}

TEST(SmoothSurface, bilinear_subdivision_changes_no_shape) {
    Mesh mesh = test::make_shape(Shape::cube);
    mesh.subdivision.scheme = SubdivisionScheme::bilinear;
    const Surface surface = make_displaced(mesh, DisplacementSpace::object);
    EXPECT_EQ(surface.patch_count(), 96u);
    EXPECT_TRUE(surface.controls.empty());
    for (const Vec3f& p : surface.positions)
        EXPECT_EQ(std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}), 1.0f);
}

/// Range of the uvs of a surface.
std::array<float, 2> find_u_range(const Surface& surface) {
    const auto [low, high] = std::minmax_element(surface.uvs.begin(), surface.uvs.end(),
                                                 [](const Vec2f& a, const Vec2f& b) { return a.x < b.x; });
    return {low->x, high->x};
}

TEST(SmoothSurface, uvs_follow_their_rule) {
    // The middle column of three is narrow in uv: smooth uvs flow, linear ones keep their lines.
    Mesh mesh = test::make_random_grid(3, 3, 0, 2);
    for (Vec2f& uv : mesh.uvs) uv.x = uv.x < 0.2f ? 0 : uv.x < 0.5f ? 0.45f : uv.x < 0.8f ? 0.55f : 1;
    mesh.subdivision.scheme = SubdivisionScheme::catmark;
    mesh.subdivision.level = 0;
    mesh.subdivision.uv = UvRule::linear;
    const auto count_on_line = [](const Surface& surface) {
        return std::count_if(surface.uvs.begin(), surface.uvs.end(),
                             [](const Vec2f& uv) { return std::fabs(uv.x - 0.45f) < 1e-6f; });
    };
    const Surface linear = make_displaced(mesh, DisplacementSpace::object);
    EXPECT_EQ(count_on_line(linear), 4);
    mesh.subdivision.uv = UvRule::smooth;
    const Surface smooth = make_displaced(mesh, DisplacementSpace::object);
    EXPECT_LT(count_on_line(smooth), 4);
    for (const Surface* surface : {&linear, &smooth}) {
        EXPECT_EQ(find_u_range(*surface)[0], 0.0f);
        EXPECT_EQ(find_u_range(*surface)[1], 1.0f);
    }
}

TEST(SmoothSurface, tells_what_cannot_be_subdivided) {
    const auto try_mesh = [](const Mesh& mesh) {
        return catch_message([&] { make_surface(mesh, nullptr, {}); });
    };
    Mesh mesh = test::make_cube();
    mesh.subdivision.scheme = SubdivisionScheme::catmark;
    EXPECT_EQ(try_mesh(mesh), "");
    Mesh fin = mesh;
    fin.positions.push_back({0, 3, 3}), fin.positions.push_back({1, 3, 3});
    test::add_face(fin, {6, 7, 9, 8}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    EXPECT_NE(try_mesh(fin).find("has 3 faces"), std::string::npos) << try_mesh(fin);
    Mesh turned = mesh;
    std::reverse(turned.position_indices.begin(), turned.position_indices.begin() + 4);
    EXPECT_NE(try_mesh(turned).find("turned against each other"), std::string::npos) << try_mesh(turned);
    Mesh pinched = mesh;
    for (const Vec3f& p : {Vec3f{3, 1, 1}, Vec3f{3, 3, 1}, Vec3f{1, 3, 1}}) pinched.positions.push_back(p);
    test::add_face(pinched, {7, 8, 9, 10}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    EXPECT_NE(try_mesh(pinched).find("share no edge"), std::string::npos) << try_mesh(pinched);
    pinched.position_indices[24] =
        uint32_t(pinched.positions.size()); // a point of its own, at the same place
    pinched.positions.push_back(Vec3f(pinched.positions[7]));
    EXPECT_EQ(try_mesh(pinched), "");
    Mesh circling = mesh;
    test::add_face(circling, {0, 1, 5, 0, 6, 7}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 1}, {0, 0}});
    EXPECT_NE(try_mesh(circling).find("comes back"), std::string::npos) << try_mesh(circling);
    Mesh folded = test::make_plane();
    folded.subdivision.scheme = SubdivisionScheme::catmark;
    folded.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}, {2, 2, 0}};
    test::add_face(folded, {3, 2, 1, 4}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    EXPECT_EQ(try_mesh(folded), "");
    folded.creases = {{1, 2, 4}};
    EXPECT_NE(try_mesh(folded).find("two faces share"), std::string::npos) << try_mesh(folded);
    Mesh creased = mesh;
    creased.creases = {{0, 7, 2}};
    EXPECT_NE(try_mesh(creased).find("along no edge"), std::string::npos) << try_mesh(creased);
    creased.creases = {{0, 70, 2}};
    EXPECT_NE(try_mesh(creased).find("out of range"), std::string::npos) << try_mesh(creased);
    creased.creases = {{0, 1, -2}};
    EXPECT_NE(try_mesh(creased).find("sharpness"), std::string::npos) << try_mesh(creased);
}

TEST(SmoothSurface, refuses_more_patches_than_can_be) {
    Mesh mesh = test::make_random_grid(60, 60, 0, 1);
    mesh.subdivision.scheme = SubdivisionScheme::catmark;
    mesh.subdivision.level = kMaxSubdivisionLevel;
    const auto expect_refusal = [](const auto& make) {
        try {
            make();
            ADD_FAILURE() << "235929600 patches were made";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::out_of_memory);
            EXPECT_NE(std::string(error.what()).find("235929600 patches"), std::string::npos) << error.what();
        }
    };
    expect_refusal([&] { make_surface(mesh, nullptr, {}); });
    expect_refusal([&] { make_uv_outlines(mesh); });
}

} // namespace

} // namespace relief
