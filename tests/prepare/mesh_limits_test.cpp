// Limit surfaces and outlines that maps and surfaces of a mesh share.
#include "prepare/mesh_limits.h"

#include <gtest/gtest.h>

#include <array>

namespace relief {

namespace {

enum : uint32_t { kByView, kLinearUvs, kFixedLevel, kPlain };

/// Three sides of a cube, each with the whole map, so that two sides meet at seams.
Mesh make_corner(SubdivisionScheme scheme, int level, UvRule uv) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    mesh.face_sizes = {4, 4, 4};
    mesh.position_indices = {0, 3, 2, 1, 0, 1, 5, 4, 0, 4, 6, 3};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.uv_indices = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
    mesh.subdivision.scheme = scheme, mesh.subdivision.level = level, mesh.subdivision.uv = uv;
    return mesh;
}

std::vector<Mesh> make_meshes() {
    const auto catmark = SubdivisionScheme::catmark;
    return {make_corner(catmark, kAutoSubdivisionLevel, UvRule::smooth),
            make_corner(catmark, kAutoSubdivisionLevel, UvRule::linear),
            make_corner(catmark, 2, UvRule::smooth), make_corner(SubdivisionScheme::none, 0, UvRule::smooth)};
}

constexpr std::array<uint32_t, 4> kAll = {kByView, kLinearUvs, kFixedLevel, kPlain};

TEST(MeshLimits, have_outlines_of_each_mesh) {
    const std::vector<Mesh> meshes = make_meshes();
    MeshLimits limits(meshes);
    limits.make_outlines(kAll);
    for (const uint32_t k : kAll) {
        const UvOutlines expected = make_uv_outlines(meshes[k]);
        EXPECT_EQ(limits.outlines(k).starts, expected.starts) << "mesh " << k;
        EXPECT_EQ(limits.outlines(k).uvs, expected.uvs) << "mesh " << k;
    }
    EXPECT_GT(limits.outlines(kByView).uvs.size(), 12u) << "points between the corners";
    EXPECT_EQ(limits.outlines(kFixedLevel).face_count(), 3u * 16) << "of patches at level 2";
    EXPECT_EQ(limits.outlines(kPlain).face_count(), 3u);
}

TEST(MeshLimits, are_kept_where_outlines_need_them) {
    const std::vector<Mesh> meshes = make_meshes();
    MeshLimits limits(meshes);
    EXPECT_EQ(limits.find(kByView), nullptr) << "before anything asks";
    limits.make_outlines(kAll);
    EXPECT_NE(limits.find(kByView), nullptr);
    for (const uint32_t k : {kLinearUvs, kFixedLevel, kPlain})
        EXPECT_EQ(limits.find(k), nullptr) << "mesh " << k;
}

TEST(MeshLimits, are_made_once) {
    const std::vector<Mesh> meshes = make_meshes();
    MeshLimits limits(meshes);
    limits.make_outlines(std::array{uint32_t(kByView)});
    const SubdivisionMesh* limit = limits.find(kByView);
    const UvOutlines* outlines = &limits.outlines(kByView);
    limits.make_outlines(kAll);
    EXPECT_EQ(&limits.outlines(kByView), outlines);
    EXPECT_EQ(limits.find_or_make(kByView), limit);
    limits.release_outlines();
    EXPECT_EQ(limits.find(kByView), limit) << "surfaces are made after the maps";
    limits.release(kByView);
    EXPECT_EQ(limits.find(kByView), nullptr);
    EXPECT_NE(limits.find_or_make(kByView), nullptr) << "made again";
}

TEST(MeshLimits, are_made_of_automatic_levels_alone) {
    const std::vector<Mesh> meshes = make_meshes();
    MeshLimits limits(meshes);
    EXPECT_NE(limits.find_or_make(kLinearUvs), nullptr);
    EXPECT_EQ(limits.find(kLinearUvs), limits.find_or_make(kLinearUvs));
    EXPECT_EQ(limits.find_or_make(kFixedLevel), nullptr);
    EXPECT_EQ(limits.find_or_make(kPlain), nullptr);
}

} // namespace

} // namespace relief
