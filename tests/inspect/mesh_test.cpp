// What inspection finds in meshes, alone and with their map.
#include <limits>

#include <gtest/gtest.h>

#include "inspect/findings.h"
#include "support/sculpt.h"

namespace relief::test {
namespace {

/// A strip of quads along x, each with uvs (column + u, v) of a grid.
Mesh make_strip(uint32_t count) {
    Mesh mesh;
    for (uint32_t x = 0; x <= count; ++x)
        for (uint32_t y = 0; y < 2; ++y) {
            mesh.positions.push_back({float(x), float(y), 0});
            mesh.uvs.push_back({float(x) / float(count), float(y)});
        }
    for (uint32_t x = 0; x < count; ++x) {
        mesh.face_sizes.push_back(4);
        for (const uint32_t corner : {2 * x, 2 * x + 2, 2 * x + 3, 2 * x + 1}) {
            mesh.position_indices.push_back(corner);
            mesh.uv_indices.push_back(corner);
        }
    }
    return mesh;
}

Displacement make_tiles(const std::vector<int>& numbers) {
    Displacement map = make_map(make_sculpt_texture(8));
    map.is_udim = true;
    map.tiles.clear();
    for (const int number : numbers) map.tiles.push_back({number, make_sculpt_texture(8)});
    return map;
}

TEST(MeshInspection, a_strip_of_quads_has_no_findings) {
    const Inspection inspection = inspect_mesh(make_strip(4));
    EXPECT_TRUE(inspection.findings.empty());
    EXPECT_EQ(get_fact(inspection, "faces"), "4: 4 quads, 0 triangles, 0 with more corners");
    EXPECT_EQ(get_fact(inspection, "points"), "by number of edges: 4 of 2, 6 of 3");
    EXPECT_EQ(get_fact(inspection, "open_edges"), "10");
    EXPECT_EQ(get_fact(inspection, "uv_islands"), "1, 0 of them mirrored");
    EXPECT_EQ(get_fact(inspection, "uv_tiles"), "1001");
    EXPECT_EQ(get_fact(inspection, "tangents"), "made from uvs");
}

TEST(MeshInspection, bounds_are_those_of_points_that_faces_have) {
    Mesh mesh = make_strip(2);
    const std::string bounds = get_fact(inspect_mesh(mesh), "bounds");
    mesh.positions.push_back({100, -100, 100});
    EXPECT_EQ(get_fact(inspect_mesh(mesh), "bounds"), bounds);
    EXPECT_EQ(bounds, "(0, 0, 0) to (2, 1, 0)");
}

TEST(MeshInspection, faces_without_area_are_named) {
    Mesh mesh = make_strip(2);
    EXPECT_FALSE(has_code(inspect_mesh(mesh), "W-AREA"));
    mesh.position_indices[7] = mesh.position_indices[6] = mesh.position_indices[5];
    EXPECT_HAS_PART(find_text(inspect_mesh(mesh), "W-AREA"), "1 of 2 faces have no area");
    EXPECT_HAS_PART(find_text(inspect_mesh(mesh), "W-AREA"), "the first is face 1");
    for (uint32_t& point : mesh.position_indices) point = 0;
    EXPECT_HAS_PART(find_text(inspect_mesh(mesh), "E-SCENE"), "zero area");
    EXPECT_FALSE(has_code(inspect_mesh(mesh), "W-AREA"));
}

TEST(MeshInspection, automatic_levels_leave_the_quads_of_a_mesh_whole) {
    Mesh mesh = make_strip(2);
    mesh.face_sizes = {5, 3}; // the corners do not matter
    EXPECT_TRUE(has_code(inspect_mesh(mesh), "I-REFINE"));
    mesh.subdivision.scheme = SubdivisionScheme::catmark, mesh.subdivision.level = 1;
    EXPECT_TRUE(has_code(inspect_mesh(mesh), "I-REFINE"));
    mesh.subdivision.level = kAutoSubdivisionLevel;
    EXPECT_FALSE(has_code(inspect_mesh(mesh), "I-REFINE"));
}

TEST(MeshInspection, uv_sets_are_told_where_there_are_several) {
    Mesh mesh = make_strip(2);
    for (const Fact& fact : inspect_mesh(mesh).facts) EXPECT_NE(fact.name, "uv_sets");
    mesh.uv_set = 1, mesh.further_uvs = {{3, mesh.uvs, mesh.uv_indices}, {0, mesh.uvs, mesh.uv_indices}};
    EXPECT_EQ(get_fact(inspect_mesh(mesh), "uv_sets"), "uv sets 0, 1 and 3");
}

TEST(MeshInspection, missing_uvs_matter_more_with_a_map) {
    Mesh mesh = make_strip(2);
    mesh.uvs.clear(), mesh.uv_indices.clear();
    EXPECT_TRUE(has_code(inspect_mesh(mesh), "W-NOUV"));
    EXPECT_EQ(get_fact(inspect_mesh(mesh), "tangents"), "none: no uvs");
    const Displacement map = make_map(make_sculpt_texture(8));
    EXPECT_TRUE(has_code(inspect_mesh(mesh, &map), "E-NOUV"));
}

TEST(MeshInspection, the_frame_of_a_map_is_told_and_must_be_there) {
    Mesh mesh = make_strip(2);
    Displacement map = make_map(make_sculpt_texture(8));
    EXPECT_HAS_PART(get_fact(inspect_mesh(mesh, &map), "frame"), "mikk");
    EXPECT_HAS_PART(get_fact(inspect_mesh(mesh, &map), "frame"), "absolute");
    map.frame = FrameKind::dpdu, map.lengths = FrameLengths::relative;
    EXPECT_HAS_PART(get_fact(inspect_mesh(mesh, &map), "frame"), "dpdu");
    EXPECT_HAS_PART(get_fact(inspect_mesh(mesh, &map), "frame"), "relative");
    map.frame = FrameKind::file, map.lengths = FrameLengths::absolute;
    EXPECT_HAS_PART(find_text(inspect_mesh(mesh, &map), "E-NONORM"), "export the mesh with normals");
    mesh.normals = {{0, 0, 1}};
    mesh.normal_indices.assign(mesh.position_indices.size(), 0);
    EXPECT_FALSE(has_code(inspect_mesh(mesh, &map), "E-NONORM"));
    EXPECT_HAS_PART(get_fact(inspect_mesh(mesh, &map), "frame"), "MikkTSpace around them");
    mesh.tangents.assign(mesh.position_indices.size(), {1, 0, 0, 1});
    EXPECT_HAS_PART(get_fact(inspect_mesh(mesh, &map), "frame"), "normals and tangents");
    map.space = DisplacementSpace::object;
    EXPECT_EQ(get_fact(inspect_mesh(mesh, &map), "frame"), "");
}

TEST(MeshInspection, faults_are_errors_and_end_the_inspection) {
    Mesh mesh = make_strip(2);
    mesh.position_indices[2] = 100;
    EXPECT_HAS_PART(find_text(inspect_mesh(mesh), "E-INDEX"), "1 indices");
    mesh = make_strip(2);
    mesh.positions[3].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_HAS_PART(find_text(inspect_mesh(mesh), "E-NAN"), "vertex 3");
    mesh = make_strip(2);
    mesh.uvs[1].x = std::numeric_limits<float>::infinity();
    EXPECT_HAS_PART(find_text(inspect_mesh(mesh), "E-NAN"), "uv 1");
    mesh = make_strip(2);
    mesh.uv_indices.pop_back();
    EXPECT_TRUE(has_code(inspect_mesh(mesh), "E-INDEX"));
}

TEST(MeshInspection, triangles_and_polygons_are_counted) {
    Mesh mesh = make_sculpt_plane();
    mesh.face_sizes = {3, 3};
    mesh.position_indices = mesh.uv_indices = {0, 1, 2, 0, 2, 3};
    EXPECT_HAS_PART(find_text(inspect_mesh(mesh), "W-TRI"), "2 of 2 faces");
    EXPECT_FALSE(has_code(inspect_mesh(mesh), "W-NGON"));
    mesh = make_strip(4);
    mesh.positions.push_back({0, 2, 0}), mesh.uvs.push_back({0, 1});
    mesh.face_sizes.push_back(5);
    for (const uint32_t corner : {1u, 3u, 5u, 7u, 10u})
        mesh.position_indices.push_back(corner), mesh.uv_indices.push_back(corner);
    EXPECT_HAS_PART(find_text(inspect_mesh(mesh), "W-NGON"), "1 of 5 faces");
    EXPECT_FALSE(has_code(inspect_mesh(mesh), "W-TRI"));
}

TEST(MeshInspection, overlapping_uvs_are_measured) {
    Mesh mesh = make_strip(4);
    for (Vec2f& uv : mesh.uvs) uv.x = uv.x < 0.5f ? uv.x : 1 - uv.x; // folded over
    const Inspection inspection = inspect_mesh(mesh);
    EXPECT_HAS_PART(find_text(inspection, "W-UVOVER"), "100.0 %");
    // Faces side by side share no middle of a cell, however they are cut.
    EXPECT_EQ(get_fact(inspect_mesh(make_strip(7)), "uv_overlap"), "0.00 % of the covered area");
}

TEST(MeshInspection, uvs_outside_need_tiles_or_a_map_that_repeats) {
    Mesh mesh = make_strip(2);
    for (Vec2f& uv : mesh.uvs) uv.x *= 2;
    const Inspection alone = inspect_mesh(mesh);
    EXPECT_HAS_PART(find_text(alone, "I-UDIM"), "1001-1002");
    EXPECT_EQ(count_severe(alone), 0u);
    Displacement map = make_map(make_sculpt_texture(8));
    EXPECT_TRUE(has_code(inspect_mesh(mesh, &map), "W-UVRANGE"));
    map.wrap = WrapMode::repeat;
    EXPECT_FALSE(has_code(inspect_mesh(mesh, &map), "W-UVRANGE"));
    for (Vec2f& uv : mesh.uvs) uv.x -= 0.5f;
    EXPECT_TRUE(has_code(inspect_mesh(mesh), "W-UVRANGE")) << "faces across two squares are no tiles";
    const Displacement tiles = make_tiles({1001, 1002});
    EXPECT_HAS_PART(find_text(inspect_mesh(mesh, &tiles), "W-UVRANGE"), "lie across two tiles or more");
    for (Vec2f& uv : mesh.uvs) uv.x -= 7.5f;
    EXPECT_HAS_PART(find_text(inspect_mesh(mesh, &tiles), "W-UVRANGE"), "outside of all tiles");
}

TEST(MeshInspection, missing_tiles_are_listed) {
    Mesh mesh = make_strip(4);
    for (Vec2f& uv : mesh.uvs) uv.x *= 4;
    const Displacement some = make_tiles({1001, 1003}), all = make_tiles({1001, 1002, 1003, 1004});
    const Inspection inspection = inspect_mesh(mesh, &some);
    EXPECT_HAS_PART(find_text(inspection, "W-GAP"), "tile(s) 1002, 1004 of the mesh");
    EXPECT_EQ(get_fact(inspection, "map_tiles"), "1001, 1003");
    EXPECT_FALSE(has_code(inspect_mesh(mesh, &all), "W-GAP"));
}

TEST(MeshInspection, edges_with_three_faces_and_faces_inside_out_are_told) {
    Mesh mesh = make_strip(2);
    mesh.positions.push_back({1, 0, 1}), mesh.positions.push_back({1, 1, 1});
    mesh.face_sizes.push_back(4);
    for (const uint32_t corner : {2u, 6u, 7u, 3u})
        mesh.position_indices.push_back(corner), mesh.uv_indices.push_back(corner % 6);
    EXPECT_HAS_PART(find_text(inspect_mesh(mesh), "W-NONMANIF"), "1 edges have more than two faces");
    mesh = make_strip(2);
    std::reverse(mesh.position_indices.begin(), mesh.position_indices.begin() + 4);
    std::reverse(mesh.uv_indices.begin(), mesh.uv_indices.begin() + 4);
    EXPECT_HAS_PART(find_text(inspect_mesh(mesh), "W-NONMANIF"), "the same way");
}

TEST(MeshInspection, points_at_equal_positions_count_as_one) {
    Mesh mesh = make_strip(2);
    std::vector<Vec3f> positions;
    for (uint32_t& index : mesh.position_indices) {
        positions.push_back(mesh.positions[index]);
        index = uint32_t(positions.size()) - 1;
    }
    mesh.positions = positions;
    EXPECT_EQ(get_fact(inspect_mesh(mesh), "open_edges"), "6");
}

TEST(MeshInspection, mirrored_islands_matter_in_tangent_space) {
    Mesh mesh = make_strip(4);
    for (size_t corner = 8; corner < 16; ++corner) { // the right half, laid over the left one, mirrored
        const Vec2f uv = mesh.uvs[mesh.uv_indices[corner]];
        mesh.uv_indices[corner] = uint32_t(mesh.uvs.size());
        mesh.uvs.push_back({1 - uv.x, uv.y});
    }
    EXPECT_HAS_PART(find_text(inspect_mesh(mesh), "W-MIRROR"), "1 of 2 uv islands are mirrored (2 faces)");
    Displacement map = make_map(make_sculpt_texture(8));
    EXPECT_TRUE(has_code(inspect_mesh(mesh, &map), "W-MIRROR"));
    map.space = DisplacementSpace::object;
    EXPECT_FALSE(has_code(inspect_mesh(mesh, &map), "W-MIRROR"));
}

} // namespace
} // namespace relief::test
