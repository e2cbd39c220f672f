// Parts that touch at a point alone are taken apart there; those that share edges are not.
#include <gtest/gtest.h>

#include "surface/mesh/join_points.h"
#include "surface/mesh/pinched_points.h"
#include "surface/smooth_shapes.h"
#include "surface/test_scenes.h"

namespace relief {
namespace {

/// Every corner of every face gets a point of its own.
Mesh take_apart(const Mesh& mesh) {
    Mesh apart = mesh;
    apart.positions.clear();
    for (size_t k = 0; k < mesh.position_indices.size(); ++k) {
        apart.positions.push_back(mesh.positions[mesh.position_indices[k]]);
        apart.position_indices[k] = uint32_t(k);
    }
    return apart;
}

size_t count_points(const Mesh& mesh) {
    std::vector<uint32_t> representatives = join_points(mesh).representatives;
    split_pinched_points(mesh, representatives);
    size_t count = 0;
    for (uint32_t point = 0; point < representatives.size(); ++point)
        count += representatives[point] == point;
    return count;
}

TEST(PinchedPoints, faces_around_a_point_that_share_edges_keep_it) {
    EXPECT_EQ(count_points(take_apart(test::make_cube())), 8u);
    EXPECT_EQ(count_points(test::make_cube()), 8u);
}

TEST(PinchedPoints, cubes_that_touch_at_a_corner_have_one_each) {
    Mesh mesh = test::make_cube();
    const size_t corners = mesh.position_indices.size();
    for (size_t k = 0; k < 8; ++k)
        mesh.positions.push_back(mesh.positions[k] + mesh.positions[7] - mesh.positions[0]);
    for (size_t k = 0; k < corners; ++k) mesh.position_indices.push_back(mesh.position_indices[k] + 8);
    mesh.face_sizes.insert(mesh.face_sizes.end(), mesh.face_sizes.begin(), mesh.face_sizes.end());
    ASSERT_EQ(mesh.positions[8], mesh.positions[7]);
    EXPECT_EQ(count_points(mesh), 16u);
    EXPECT_EQ(count_points(take_apart(mesh)), 16u);
}

TEST(PinchedPoints, points_without_faces_stay_with_those_at_their_place) {
    Mesh mesh = test::make_cube();
    mesh.positions.push_back(Vec3f(mesh.positions[3]));
    std::vector<uint32_t> representatives = join_points(mesh).representatives;
    split_pinched_points(mesh, representatives);
    EXPECT_EQ(representatives[8], 3u);
}

/// The second point of a face is at the place of the first one, and the neighbour has that one alone.
TEST(PinchedPoints, edges_without_length_keep_their_ends_together) {
    Mesh mesh = test::make_plane();
    mesh.positions.push_back(Vec3f(mesh.positions[1]));
    mesh.positions.insert(mesh.positions.end(), {{2, 0, 0}, {2, 1, 0}});
    mesh.position_indices = {0, 1, 4, 2, 3, 4, 5, 6, 2};
    mesh.face_sizes = {5, 4};
    std::vector<uint32_t> representatives = join_points(mesh).representatives;
    split_pinched_points(mesh, representatives);
    EXPECT_EQ(representatives[4], 1u);
}

} // namespace
} // namespace relief
