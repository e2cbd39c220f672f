// Uv sets beside that of the mesh go the way that the mesh's own go, and change nothing else.
#include <gtest/gtest.h>

#include "surface/smooth_shapes.h"

namespace relief {
namespace {

using test::Shape;

constexpr int kSet = 3;
constexpr std::array<int, 1> kWanted{kSet};

/// With the uvs once more as a set beside them, numbered in another way.
Mesh repeat_uvs(Mesh mesh) {
    UvSet set{kSet, {}, {}};
    for (const uint32_t index : mesh.uv_indices) {
        set.indices.push_back(index == kNoIndex ? kNoIndex : uint32_t(set.uvs.size()));
        set.uvs.push_back(index == kNoIndex ? Vec2f{9, 9} : mesh.uvs[index]);
    }
    mesh.further_uvs = {UvSet{1, {{7, 7}}, std::vector<uint32_t>(mesh.uv_indices.size(), 0)}, set};
    return mesh;
}

void expect_equal_uvs(const Surface& surface) {
    ASSERT_EQ(surface.further_uvs.size(), 1u) << "nobody wants the other";
    const PatchUvs* found = surface.find_further_uvs(kSet);
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(surface.find_further_uvs(1), nullptr);
    ASSERT_EQ(found->corners.size(), surface.patch_count());
    for (uint32_t patch = 0; patch < surface.patch_count(); ++patch)
        for (size_t k = 0; k < 4; ++k)
            ASSERT_EQ(found->corners[patch][k], surface.uvs[surface.quads[patch].vertex[k]])
                << "patch " << patch << ", corner " << k;
}

void expect_same_shape(const Surface& a, const Surface& b) {
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.uvs, b.uvs);
    EXPECT_EQ(a.controls, b.controls);
    EXPECT_EQ(a.overrides.size(), b.overrides.size());
    ASSERT_EQ(a.patch_count(), b.patch_count());
    for (uint32_t patch = 0; patch < a.patch_count(); ++patch) EXPECT_EQ(a.quads[patch], b.quads[patch]);
}

void expect_followed(const Mesh& mesh) {
    const Displacement map = test::make_displacement(test::make_noise(8, 8, 0.1f, 4));
    for (const Displacement* displacement : {static_cast<const Displacement*>(nullptr), &map}) {
        const Surface surface = make_surface(repeat_uvs(mesh), displacement, {{}, nullptr, kWanted, {}});
        expect_equal_uvs(surface);
        const Surface plain = make_surface(mesh, displacement, {});
        expect_same_shape(surface, plain);
        EXPECT_TRUE(plain.further_uvs.empty());
        EXPECT_EQ(surface.geometry_bytes() - plain.geometry_bytes(), surface.patch_count() * 32u);
    }
}

TEST(FurtherUvs, are_subdivided_as_those_of_the_mesh) {
    for (const Shape shape : test::kAllShapes)
        for (const SubdivisionScheme scheme : {SubdivisionScheme::catmark, SubdivisionScheme::bilinear})
            for (const UvRule rule : {UvRule::smooth, UvRule::linear}) {
                SCOPED_TRACE(testing::Message() << int(shape) << ' ' << int(scheme) << ' ' << int(rule));
                Mesh mesh = test::make_shape(shape);
                mesh.subdivision.scheme = scheme, mesh.subdivision.uv = rule;
                expect_followed(mesh);
            }
}

TEST(FurtherUvs, follow_islands_of_their_own_through_subdivision) {
    Mesh mesh = test::make_random_grid(4, 4, 0, 5);
    mesh.subdivision.scheme = SubdivisionScheme::catmark, mesh.subdivision.level = 2;
    Mesh torn = test::make_random_grid(4, 4, 0.8f, 5);
    torn.subdivision = mesh.subdivision;
    ASSERT_EQ(mesh.positions, torn.positions);
    mesh.position_indices = torn.position_indices, mesh.uv_indices = torn.position_indices;
    mesh.uvs.clear();
    for (const Vec3f& p : mesh.positions) mesh.uvs.push_back({p.x, p.y});
    mesh.further_uvs = {{kSet, torn.uvs, torn.uv_indices}};
    const Surface whole = make_surface(mesh, nullptr, {{}, nullptr, kWanted, {}});
    const Surface expected = make_surface(torn, nullptr, {});
    for (uint32_t patch = 0; patch < whole.patch_count(); ++patch)
        for (size_t k = 0; k < 4; ++k)
            ASSERT_EQ(whole.further_uvs.at(0).corners[patch][k],
                      expected.uvs[expected.quads[patch].vertex[k]]);
}

TEST(FurtherUvs, follow_polygons_into_patches) {
    for (const float seams : {0.0f, 0.6f}) expect_followed(test::make_random_grid(5, 4, seams, 8));
    Mesh polygons = test::make_pyramid();
    polygons.positions.push_back({2, 0.5f, 0.2f}), polygons.positions.push_back({1.6f, 0.5f, 0.1f});
    // A pentagon that is not convex, and a face without an area beside it.
    test::add_face(polygons, {1, 5, 2, 6, 0}, {{0, 0}, {1, 0.5f}, {0, 1}, {0.2f, 0.5f}, {0.1f, 0.3f}});
    test::add_face(polygons, {1, 5, 5}, {{0, 0}, {1, 0.5f}, {1, 0.5f}});
    expect_followed(polygons);
}

TEST(FurtherUvs, are_zero_on_faces_that_have_none) {
    Mesh mesh = repeat_uvs(test::make_random_grid(2, 1, 0, 3));
    for (size_t corner = 4; corner < 8; ++corner) mesh.further_uvs[1].indices[corner] = kNoIndex;
    const Surface surface = make_surface(mesh, nullptr, {{}, nullptr, kWanted, {}});
    const PatchUvs& found = surface.further_uvs.at(0);
    EXPECT_EQ(found.corners.at(1), (std::array<Vec2f, 4>{}));
    EXPECT_NE(found.corners.at(0), (std::array<Vec2f, 4>{}));
}

TEST(FurtherUvs, of_a_mesh_without_its_own_are_subdivided_too) {
    Mesh mesh = test::make_cube();
    mesh.subdivision.scheme = SubdivisionScheme::catmark, mesh.subdivision.level = 1;
    const Surface expected = make_surface(mesh, nullptr, {});
    mesh.further_uvs = {{kSet, mesh.uvs, mesh.uv_indices}};
    mesh.uvs.clear(), mesh.uv_indices.clear();
    const Surface surface = make_surface(mesh, nullptr, {{}, nullptr, kWanted, {}});
    EXPECT_TRUE(surface.uvs.empty());
    for (uint32_t patch = 0; patch < surface.patch_count(); ++patch)
        for (size_t k = 0; k < 4; ++k)
            ASSERT_EQ(surface.further_uvs.at(0).corners[patch][k],
                      expected.uvs[expected.quads[patch].vertex[k]]);
}

} // namespace
} // namespace relief
