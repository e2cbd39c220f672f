// Points that nearly coincide are joined where open edges lie on each other, and nowhere else.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <set>

#include "surface/mesh/join_points.h"
#include "surface/mesh/open_edges.h"
#include "surface/mesh/polygons.h"

namespace relief {
namespace {

size_t count_open_edges(const Mesh& mesh, const std::vector<uint32_t>& representatives) {
    std::vector<uint32_t> points;
    for (const uint32_t index : mesh.position_indices) points.push_back(representatives[index]);
    return list_open_edges(mesh.face_sizes, points, mesh.positions.size()).size();
}

size_t count_open_edges(const Mesh& mesh) {
    return count_open_edges(mesh, join_points(mesh).representatives);
}

void add_quad(Mesh& mesh, const std::array<Vec3f, 4>& corners) {
    mesh.face_sizes.push_back(4);
    for (const Vec3f& corner : corners) {
        mesh.position_indices.push_back(uint32_t(mesh.positions.size()));
        mesh.positions.push_back(corner);
    }
}

/// A cube [-1, 1]^3 at `offset` whose six faces have corners of their own, each moved by up to `error` along
/// each axis.
Mesh make_loose_cube(float error, const Vec3f& offset = {}) {
    constexpr std::array<std::array<int, 4>, 6> kFaces = {
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    std::mt19937 random(3);
    const auto move = [&](int bit) {
        return (bit ? 1.0f : -1.0f) + error * (float(random() % 2001) / 1000 - 1);
    };
    Mesh mesh;
    mesh.name = "cube";
    for (const std::array<int, 4>& face : kFaces) {
        std::array<Vec3f, 4> corners;
        for (size_t k = 0; k < 4; ++k) {
            const float x = move(face[k] & 1), y = move(face[k] & 2), z = move(face[k] & 4);
            corners[k] = {offset.x + x, offset.y + y, offset.z + z};
        }
        add_quad(mesh, corners);
    }
    return mesh;
}

/// Two squares of side 1 beside each other, `gap` apart along x.
Mesh make_pair(float gap) {
    Mesh mesh;
    mesh.name = "pair";
    add_quad(mesh, {Vec3f{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}});
    add_quad(mesh, {Vec3f{gap, 0, 0}, {1 + gap, 0, 0}, {1 + gap, 1, 0}, {gap, 1, 0}});
    return mesh;
}

TEST(JoinPoints, faces_with_points_of_their_own_become_a_closed_cube) {
    const Mesh mesh = make_loose_cube(1e-6f);
    const JoinedPoints joined = join_points(mesh);
    EXPECT_EQ(count_open_edges(mesh, joined.representatives), 0u);
    EXPECT_EQ(joined.joined_edges, 24u);
    EXPECT_GE(joined.moved_points, 12u);
    EXPECT_GT(joined.farthest, 5e-7f);
    EXPECT_LE(joined.farthest, 2.5e-6f);
    const Polygons polygons = make_polygons(mesh, Welding::joined_points);
    EXPECT_EQ(std::set(polygons.points.begin(), polygons.points.end()).size(), 8u);
}

TEST(JoinPoints, rounding_of_large_coordinates_is_joined_and_gaps_there_are_not) {
    EXPECT_EQ(count_open_edges(make_loose_cube(6e-5f, {1000, 0, 0})), 0u) << "a unit in the last place";
    EXPECT_EQ(count_open_edges(make_loose_cube(6e-5f)), 24u);
    EXPECT_EQ(count_open_edges(make_loose_cube(1e-3f, {1000, 0, 0})), 24u);
    EXPECT_EQ(find_near_edges(make_loose_cube(4e-4f, {1000, 0, 0})).count, 24u) << "neither joined nor far";
    Mesh mesh = make_pair(3);
    for (Vec3f& p : mesh.positions) p = Vec3f{10 * p.x + 1e6f, 10 * p.y, 10 * p.z};
    EXPECT_EQ(count_open_edges(mesh), 8u);
    EXPECT_EQ(find_near_edges(mesh).count, 0u);
}

/// Its normal is worked out once, not for each of its edges.
TEST(JoinPoints, a_polygon_of_many_open_edges_is_looked_at_once) {
    constexpr uint32_t kCorners = 200000;
    Mesh mesh;
    for (uint32_t k = 0; k < kCorners; ++k) {
        const double angle = 2 * 3.14159265358979 * k / kCorners;
        mesh.position_indices.push_back(k);
        mesh.positions.push_back({float(1e4 * std::cos(angle)), float(1e4 * std::sin(angle)), 0});
    }
    mesh.face_sizes = {kCorners};
    EXPECT_EQ(join_points(mesh).joined_edges, 0u);
}

TEST(JoinPoints, points_of_no_face_do_not_count) {
    Mesh mesh = make_pair(0.3f);
    mesh.positions.push_back({1e6f, 0, 0});
    EXPECT_EQ(count_open_edges(mesh), 8u);
    mesh = make_pair(1e-7f);
    mesh.positions.push_back({1e-9f, 1e6f, 0});
    EXPECT_EQ(count_open_edges(mesh), 6u);
}

/// Two strips of quads beside each other, whose common edges are four units in the last place long.
TEST(JoinPoints, edges_shorter_than_the_reach_are_joined) {
    Mesh mesh;
    constexpr float kUnit = 0x1p-14f, kLength = 4 * kUnit; // at 1000
    for (int k = 0; k < 50; ++k)
        for (const float x : {1000.0f, 1001.0f}) {
            const float left = x > 1000 ? x + kUnit : x, y = float(k) * kLength;
            add_quad(mesh,
                     {Vec3f{left, y, 0}, {x + 1, y, 0}, {x + 1, y + kLength, 0}, {left, y + kLength, 0}});
        }
    EXPECT_EQ(count_open_edges(mesh), 2u * 50 + 4);
    EXPECT_EQ(find_near_edges(mesh).count, 0u);
}

TEST(JoinPoints, a_weld_of_zero_joins_equal_positions_alone) {
    Mesh mesh = make_loose_cube(1e-6f);
    mesh.weld = 0.0f;
    EXPECT_EQ(count_open_edges(mesh), 24u);
    EXPECT_EQ(find_near_edges(mesh).count, 0u) << "the distance is meant";
    mesh = make_loose_cube(0);
    mesh.weld = 0.0f;
    EXPECT_EQ(count_open_edges(mesh), 0u);
    EXPECT_EQ(join_points(mesh).moved_points, 0u);
}

TEST(JoinPoints, a_gap_stays_open_unless_weld_is_wider) {
    for (const float gap : {1e-5f, 1e-3f}) {
        Mesh mesh = make_pair(gap);
        EXPECT_EQ(count_open_edges(mesh), 8u);
        mesh.weld = 1.01f * gap;
        EXPECT_EQ(count_open_edges(mesh), 6u);
        mesh.weld = 0.99f * gap;
        EXPECT_EQ(count_open_edges(mesh), 8u);
    }
}

TEST(JoinPoints, edges_that_stay_apart_nearby_are_counted_with_the_distance_that_joins_them) {
    Mesh mesh = make_pair(1.23e-5f);
    const NearEdges edges = find_near_edges(mesh);
    EXPECT_EQ(edges.count, 2u);
    EXPECT_NEAR(edges.weld, 1.3e-5f, 1e-7f);
    mesh.weld = edges.weld;
    EXPECT_EQ(count_open_edges(mesh), 6u);
    EXPECT_EQ(find_near_edges(mesh).count, 0u);
    EXPECT_EQ(find_near_edges(make_pair(1e-3f)).count, 0u);
    EXPECT_EQ(find_near_edges(make_pair(1e-7f)).count, 0u) << "joined";
}

TEST(JoinPoints, faces_that_fold_back_onto_each_other_stay_apart) {
    Mesh mesh = make_pair(0);
    for (size_t k = 4; k < 8; ++k) mesh.positions[k].x = -mesh.positions[k].x, mesh.positions[k].z = 1e-7f;
    EXPECT_EQ(count_open_edges(mesh), 8u) << "the left square a second time, upside down";
    EXPECT_EQ(find_near_edges(mesh).count, 0u);
    mesh.weld = 0.1f;
    EXPECT_EQ(count_open_edges(mesh), 8u);
}

/// A double sheet goes on as one: each side keeps to its own.
TEST(JoinPoints, both_sides_of_a_double_sheet_stay_apart) {
    Mesh mesh = make_pair(1e-7f);
    const Mesh front = mesh;
    for (size_t k = 0; k < 8; k += 4)
        add_quad(mesh, {Vec3f{front.positions[k + 3].x, 1, 2e-7f},
                        {front.positions[k + 2].x, 1, 2e-7f},
                        {front.positions[k + 1].x, 0, 2e-7f},
                        {front.positions[k].x, 0, 2e-7f}});
    EXPECT_EQ(count_open_edges(mesh), 12u);
}

TEST(JoinPoints, three_sheets_that_meet_become_one_edge) {
    Mesh mesh = make_pair(1e-7f);
    add_quad(mesh, {Vec3f{0, 0, 2e-7f}, {0, 1, 2e-7f}, {0, 1, 1}, {0, 0, 1}});
    EXPECT_EQ(count_open_edges(mesh), 9u);
}

TEST(JoinPoints, no_face_loses_a_corner_whatever_the_distance) {
    Mesh mesh;
    for (int k = 0; k < 20; ++k) { // a strip of narrow quads, each a little apart
        const float x = float(k) * 0.0101f;
        add_quad(mesh, {Vec3f{x, 0, 0}, {x + 0.01f, 0, 0}, {x + 0.01f, 1, 0}, {x, 1, 0}});
    }
    for (const float weld : {1e-4f, 0.0002f, 0.004f, 0.02f, 0.6f, 10.0f}) {
        mesh.weld = weld;
        const std::vector<uint32_t> points = join_points(mesh).representatives;
        for (size_t face = 0; face < mesh.face_sizes.size(); ++face) {
            std::set<uint32_t> corners;
            for (size_t k = 0; k < 4; ++k) corners.insert(points[mesh.position_indices[4 * face + k]]);
            EXPECT_EQ(corners.size(), 4u) << "face " << face << ", weld " << weld;
        }
    }
    mesh.weld = 0.0002f;
    EXPECT_EQ(count_open_edges(mesh), 42u);
}

} // namespace
} // namespace relief
