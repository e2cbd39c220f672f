// Faces without area are left out; what was closed stays closed.
#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "relief/error.h"
#include "surface/mesh/degenerate_faces.h"

namespace relief {
namespace {

/// A tetrahedron a, c, d, e whose edge from a to c has b in its middle on one side only; a sliver c b a joins
/// them.
Mesh make_sliver_mesh() {
    enum : uint32_t { a, b, c, d, e };
    Mesh mesh;
    mesh.name = "sliver";
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {4, 0, 0}, {0, 2, 0}, {0, 0, 2}};
    mesh.position_indices = {a, b, d, b, c, d, c, b, a, c, a, e, a, d, e, c, e, d};
    mesh.face_sizes.assign(6, 3);
    for (const uint32_t index : mesh.position_indices) mesh.uvs.push_back({mesh.positions[index].x, 0.5f});
    for (uint32_t k = 0; k < mesh.position_indices.size(); ++k) mesh.uv_indices.push_back(k);
    return mesh;
}

bool is_closed(const Polygons& polygons) {
    std::multiset<std::pair<uint32_t, uint32_t>> edges;
    for (uint32_t face = 0; face < polygons.face_count(); ++face)
        for (uint32_t k = 0; k < polygons.face_size(face); ++k) {
            const uint32_t start = polygons.starts[face];
            edges.insert(
                {polygons.points[start + k], polygons.points[start + (k + 1) % polygons.face_size(face)]});
        }
    for (const auto& [first, second] : edges)
        if (edges.count({second, first}) != 1 || edges.count({first, second}) != 1) return false;
    return !edges.empty();
}

TEST(DegenerateFaces, a_sliver_goes_into_the_edge_of_its_neighbour) {
    const Polygons polygons = make_polygons(make_sliver_mesh(), Welding::joined_points);
    EXPECT_EQ(polygons.face_count(), 5u);
    EXPECT_TRUE(is_closed(polygons));
    // The face c a e has become c b a e, with the uv of b between those of c and a.
    ASSERT_EQ(polygons.face_size(2), 4u);
    EXPECT_EQ(polygons.points[polygons.starts[2] + 1], 1u);
    EXPECT_EQ(polygons.uvs[polygons.starts[2] + 1], (Vec2f{1, 0.5f}));
    EXPECT_EQ(polygons.source_faces[2], 3u) << "messages name the face of the file";
}

TEST(DegenerateFaces, faces_that_are_a_line_or_a_point_are_left_out) {
    Mesh mesh = make_sliver_mesh();
    // An edge twice, and a point three times.
    for (const uint32_t index : {3u, 4u, 4u, 1u, 1u, 1u}) {
        mesh.position_indices.push_back(index);
        mesh.uv_indices.push_back(0);
    }
    mesh.face_sizes.insert(mesh.face_sizes.end(), 2, 3);
    EXPECT_TRUE(is_closed(make_polygons(mesh, Welding::joined_points)));
    const DegenerateFaces faces = find_degenerate_faces(mesh);
    EXPECT_EQ(faces.count, 3u);
    EXPECT_EQ(faces.first, 2u);
}

TEST(DegenerateFaces, split_points_of_equal_position_are_one_edge) {
    Mesh mesh = make_sliver_mesh();
    // The sliver has points of its own.
    for (size_t k = 6; k < 9; ++k) {
        mesh.positions.push_back(mesh.positions[mesh.position_indices[k]]);
        mesh.position_indices[k] = uint32_t(mesh.positions.size() - 1);
    }
    EXPECT_EQ(make_polygons(mesh, Welding::none).face_size(2), 4u);
}

/// The edge a c of the tetrahedron has two points on one side, which a row of slivers joins to the other.
TEST(DegenerateFaces, slivers_beside_each_other_go_into_one_edge) {
    for (const bool is_fan : {false, true}) {
        enum : uint32_t { a, b, c, d, e, f };
        Mesh mesh;
        mesh.name = "slivers";
        mesh.positions = {{0, 0, 0}, {1, 0, 0}, {4, 0, 0}, {0, 2, 0}, {0, 0, 2}, {3, 0, 0}};
        mesh.position_indices = {a, b, d, b, f, d, f, c, d, c, a, e, a, d, e, c, e, d};
        const std::vector<uint32_t> slivers =
            is_fan ? std::vector<uint32_t>{c, f, a, f, b, a} : std::vector<uint32_t>{c, b, a, c, f, b};
        mesh.position_indices.insert(mesh.position_indices.end(), slivers.begin(), slivers.end());
        mesh.face_sizes.assign(8, 3);
        for (const uint32_t index : mesh.position_indices)
            mesh.uv_indices.push_back(uint32_t(mesh.uvs.size())),
                mesh.uvs.push_back({mesh.positions[index].x, 0});
        const Polygons polygons = make_polygons(mesh, Welding::joined_points);
        EXPECT_TRUE(is_closed(polygons)) << is_fan;
        ASSERT_EQ(polygons.face_count(), 6u);
        ASSERT_EQ(polygons.face_size(3), 5u);
        for (uint32_t corner = 0; corner < polygons.points.size(); ++corner)
            EXPECT_NEAR(polygons.uvs[corner].x, polygons.positions[polygons.points[corner]].x, 1e-6f);
    }
}

/// Each sliver of a fan has the next one across its longest edge; the last one has a face.
TEST(DegenerateFaces, a_long_row_of_slivers_goes_into_one_edge) {
    constexpr uint32_t kSlivers = 20000;
    Mesh mesh;
    mesh.name = "row";
    for (uint32_t k = 0; k <= kSlivers + 1; ++k) mesh.positions.push_back({float(k) * 0x1p-10f, 0, 0});
    for (uint32_t k = 1; k <= kSlivers; ++k)
        mesh.position_indices.insert(mesh.position_indices.end(), {0, k, k + 1});
    mesh.positions.push_back({0, 1, 0});
    mesh.position_indices.insert(mesh.position_indices.end(), {0, kSlivers + 1, kSlivers + 2});
    mesh.face_sizes.assign(kSlivers + 1, 3);
    const Polygons polygons = make_polygons(mesh, Welding::joined_points);
    ASSERT_EQ(polygons.face_count(), 1u);
    EXPECT_EQ(polygons.face_size(0), kSlivers + 3);
}

TEST(DegenerateFaces, a_mesh_of_nothing_else_is_refused) {
    Mesh mesh = make_sliver_mesh();
    mesh.face_sizes = {3}, mesh.position_indices = {2, 1, 0}, mesh.uv_indices = {0, 0, 0};
    EXPECT_THROW(make_polygons(mesh, Welding::joined_points), Error);
}

} // namespace
} // namespace relief
