#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "surface/mesh/polygons.h"
#include "surface/test_scenes.h"

namespace relief {

namespace {

using Outline = std::vector<Vec2f>;

Outline make_c() {
    return {{-1, -1}, {1, -1}, {1, -0.8f}, {-0.8f, -0.8f}, {-0.8f, 0.8f}, {1, 0.8f}, {1, 1}, {-1, 1}};
}
Outline make_l() { return {{-1, -1}, {1, -1}, {1, -0.4f}, {-0.3f, -0.4f}, {-0.3f, 0.9f}, {-1, 0.9f}}; }
Outline make_dart() { return {{-1, -1}, {0, -0.2f}, {1, -1}, {0, 1}}; }
/// A pentagram drawn along its outline: concave at every second corner.
Outline make_star() {
    Outline star;
    for (int k = 0; k < 10; ++k) {
        const float angle = std::numbers::pi_v<float> * float(k) / 5, radius = k % 2 == 0 ? 1.0f : 0.3f;
        star.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    return star;
}

double compute_area(const Outline& outline) {
    double twice = 0;
    for (size_t k = 0; k < outline.size(); ++k) {
        const Vec2f &a = outline[k], &b = outline[(k + 1) % outline.size()];
        twice += double(a.x) * b.y - double(a.y) * b.x;
    }
    return twice / 2;
}

/// Two copies of an outline with walls in between: a closed body. The third coordinate is turned into
/// the others, so that no face is parallel to an axis.
Mesh make_prism(const Outline& outline, float height) {
    Mesh mesh;
    const uint32_t size = uint32_t(outline.size());
    std::vector<uint32_t> bottom, top;
    std::vector<Vec2f> uvs_bottom, uvs_top;
    for (const float z : {0.0f, height})
        for (const Vec2f& p : outline)
            mesh.positions.push_back({0.8f * p.x - 0.6f * z, 0.36f * p.x + 0.8f * p.y + 0.48f * z,
                                      0.48f * p.x - 0.6f * p.y + 0.64f * z});
    for (uint32_t k = 0; k < size; ++k) {
        top.push_back(size + k), bottom.push_back(size - 1 - k);
        uvs_top.push_back(outline[k]), uvs_bottom.push_back(outline[size - 1 - k]);
    }
    test::add_face(mesh, top, uvs_top);
    test::add_face(mesh, bottom, uvs_bottom);
    for (uint32_t k = 0; k < size; ++k)
        test::add_face(mesh, {k, (k + 1) % size, size + (k + 1) % size, size + k},
                       {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    return mesh;
}

/// Area of a patch as it is hit: two triangles a cell.
double compute_patch_area(const Surface& surface, uint32_t patch) {
    constexpr uint8_t kLevel = 2;
    const PatchLevels levels{kLevel, {kLevel, kLevel, kLevel, kLevel}};
    const auto vertex = [&](uint32_t i, uint32_t j) { return evaluate_vertex(surface, patch, levels, i, j); };
    double area = 0;
    for (uint32_t j = 0; j < 1u << kLevel; ++j)
        for (uint32_t i = 0; i < 1u << kLevel; ++i) {
            const Vec3f a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1),
                        d = vertex(i, j + 1);
            area += double(length(cross(b - a, c - a)) + length(cross(c - a, d - a))) / 2;
        }
    return area;
}

double compute_displaced_area(const Surface& surface) {
    double area = 0;
    for (uint32_t patch = 0; patch < surface.patch_count(); ++patch)
        area += compute_patch_area(surface, patch);
    return area;
}

double compute_plain_area(const Surface& surface) {
    double area = 0;
    for (const Quad quad : surface.quads) {
        const auto p = [&](size_t k) { return surface.position(quad.vertex[k]); };
        area += double(length(cross(p(1) - p(0), p(2) - p(0))) + length(cross(p(2) - p(0), p(3) - p(0)))) / 2;
    }
    return area;
}

/// Every edge is used once in each direction.
void expect_closed(const Surface& surface) {
    std::map<std::pair<uint32_t, uint32_t>, int> uses;
    for (const Quad quad : surface.quads)
        for (int k = 0; k < 4; ++k)
            ++uses[{surface.dominant(quad.vertex[k]), surface.dominant(quad.vertex[(k + 1) & 3])}];
    for (const auto& [edge, count] : uses) {
        EXPECT_EQ(count, 1);
        EXPECT_EQ(uses.count(std::pair(edge.second, edge.first)), 1u);
    }
}

Displacement make_flat_map() { return test::make_displacement(test::make_constant(4, 4, {0, 0, 0})); }

struct NamedOutline {
    const char* name;
    Outline outline;
};
std::vector<NamedOutline> list_outlines() {
    return {{"C", make_c()}, {"L", make_l()}, {"dart", make_dart()}, {"star", make_star()}};
}

TEST(ConcaveFaces, displaced_bodies_are_closed_and_have_the_area_of_their_faces) {
    const Displacement displacement = make_flat_map();
    for (const SubdivisionScheme scheme : {SubdivisionScheme::none, SubdivisionScheme::bilinear})
        for (const NamedOutline& shape : list_outlines()) {
            SCOPED_TRACE(shape.name);
            Mesh mesh = make_prism(shape.outline, 0.5f);
            mesh.subdivision.scheme = scheme, mesh.subdivision.level = 2;
            double around = 0;
            for (size_t k = 0; k < shape.outline.size(); ++k) {
                const Vec2f side = shape.outline[(k + 1) % shape.outline.size()] - shape.outline[k];
                around += std::hypot(double(side.x), double(side.y));
            }
            const double area = 2 * compute_area(shape.outline) + 0.5 * around;
            const Surface displaced = make_surface(mesh, &displacement, {});
            EXPECT_NEAR(compute_displaced_area(displaced), area, 1e-5 * area);
            expect_closed(displaced);
            EXPECT_NEAR(compute_plain_area(make_surface(mesh, nullptr, {})), area, 1e-5 * area);
        }
}

/// Other faces than quads refine a whole mesh; a concave quad becomes two quads instead.
TEST(ConcaveFaces, a_concave_quad_leaves_the_other_quads_whole) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0.5f, 0.5f, 0}, {0, 2, 0}, {4, 0, 0}, {4, 2, 0}};
    mesh.face_sizes = {4, 4};
    mesh.position_indices = {0, 1, 2, 3, 1, 4, 5, 2};
    for (const Vec3f& p : mesh.positions) mesh.uvs.push_back({p.x / 4, p.y / 4});
    mesh.uv_indices = mesh.position_indices;
    const Displacement displacement = make_flat_map();
    const Surface surface = make_surface(mesh, &displacement, {});
    EXPECT_EQ(surface.patch_count(), 3u);
    const double dart = compute_area({{0, 0}, {2, 0}, {0.5f, 0.5f}, {0, 2}});
    const double beside = compute_area({{2, 0}, {4, 0}, {4, 2}, {0.5f, 0.5f}});
    EXPECT_NEAR(compute_displaced_area(surface), dart + beside, 1e-5);
}

TEST(ConcaveFaces, two_faces_that_are_cut_between_the_same_points_stay_apart) {
    const Displacement displacement = make_flat_map();
    for (const SubdivisionScheme scheme : {SubdivisionScheme::none, SubdivisionScheme::bilinear})
        for (const NamedOutline& shape : list_outlines()) {
            SCOPED_TRACE(shape.name);
            const Mesh prism = make_prism(shape.outline, 0);
            Mesh pillow;
            pillow.positions = prism.positions;
            pillow.subdivision.scheme = scheme, pillow.subdivision.level = 1;
            std::vector<uint32_t> there, back;
            for (uint32_t k = 0; k < shape.outline.size(); ++k)
                there.push_back(k), back.insert(back.begin(), k);
            Outline uvs_back(shape.outline.rbegin(), shape.outline.rend());
            test::add_face(pillow, there, shape.outline);
            test::add_face(pillow, back, uvs_back);
            const Surface surface = make_surface(pillow, &displacement, {});
            const double area = 2 * compute_area(shape.outline);
            EXPECT_NEAR(compute_displaced_area(surface), area, 1e-5 * area);
            expect_closed(surface);
        }
}

TEST(ConcaveFaces, cuts_carry_uvs_normals_and_tangents_and_add_no_points_on_edges) {
    Polygons polygons;
    const Outline outline = make_c();
    for (uint32_t k = 0; k < outline.size(); ++k) {
        polygons.positions.push_back({outline[k].x, outline[k].y, 0});
        polygons.points.push_back(k);
        polygons.uvs.push_back(outline[k] * 2.0f);
        polygons.normals.push_back({0, 0, float(k)});
        polygons.tangents.push_back({float(k), 0, 0, -1});
    }
    polygons.further_uvs.push_back({3, outline});
    polygons.starts = {0, uint32_t(outline.size())};
    polygons.source_faces = {7};
    polygons.creases.push_back({0, 1, 2.0f});
    const Polygons cut = cut_concave_faces(polygons);
    EXPECT_EQ(cut.positions, polygons.positions);
    EXPECT_EQ(cut.face_count(), outline.size() - 2);
    EXPECT_EQ(cut.creases.size(), 1u);
    ASSERT_EQ(cut.uvs.size(), cut.points.size());
    for (size_t corner = 0; corner < cut.points.size(); ++corner) {
        const uint32_t k = cut.points[corner];
        EXPECT_EQ(cut.uvs[corner], polygons.uvs[k]);
        EXPECT_EQ(cut.normals[corner], polygons.normals[k]);
        EXPECT_EQ(cut.tangents[corner], polygons.tangents[k]);
        EXPECT_EQ(cut.further_uvs[0].uvs[corner], outline[k]);
    }
    EXPECT_EQ(cut.source_faces, std::vector<uint32_t>(outline.size() - 2, 7));
}

TEST(ConcaveFaces, convex_faces_stay_whole_also_with_corners_on_a_line) {
    Polygons polygons;
    // A slanted rectangle whose longer sides have points that rounding puts to either side of them.
    for (int k = 0; k <= 10; ++k) polygons.positions.push_back({float(k) * 0.1f, float(k) * 0.07f, 0.3f});
    for (int k = 10; k >= 0; --k)
        polygons.positions.push_back({float(k) * 0.1f - 0.07f, float(k) * 0.07f + 0.1f, 0.3f});
    for (uint32_t k = 0; k < polygons.positions.size(); ++k) polygons.points.push_back(k);
    polygons.starts = {0, uint32_t(polygons.points.size())};
    polygons.source_faces = {0};
    EXPECT_EQ(cut_concave_faces(polygons).face_count(), 1u);
    // The same corners pulled in at one place by a thousandth are concave.
    polygons.positions[5].y += 1e-3f;
    EXPECT_GT(cut_concave_faces(polygons).face_count(), 1u);
}

TEST(ConcaveFaces, faces_that_are_not_flat_are_cut_in_their_mean_plane) {
    // A dart whose tip is bent out of the plane: seen from above its area is that of the dart.
    Mesh mesh;
    mesh.positions = {{-1, -1, 0.2f}, {0, -0.2f, -0.2f}, {1, -1, 0.2f}, {0, 1, -0.2f}};
    test::add_face(mesh, {0, 1, 2, 3}, make_dart());
    const Displacement displacement = make_flat_map();
    Surface surface = make_surface(mesh, &displacement, {});
    for (Vec3f& p : surface.positions) p.z = 0;
    EXPECT_NEAR(compute_displaced_area(surface), compute_area(make_dart()), 1e-5);
}

} // namespace

} // namespace relief
