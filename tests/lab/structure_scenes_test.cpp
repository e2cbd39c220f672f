#include "lab/scenes/structure_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <gtest/gtest.h>

#include "math/vec.h"
#include "relief/error.h"

namespace relief {
namespace {

double area_of(const Mesh& mesh, size_t triangle) {
    const auto corner = [&](size_t k) { return mesh.positions[mesh.position_indices[3 * triangle + k]]; };
    return 0.5 * double(length(cross(corner(1) - corner(0), corner(2) - corner(0))));
}

TEST(StructureScenes, have_the_numbers_of_triangles_that_papers_have) {
    const std::pair<const char*, size_t> expected[] = {{"body", 69312}, {"hall", 278490}, {"knot", 2097152}};
    for (const auto& [name, triangles] : expected)
        EXPECT_EQ(make_structure_scene(name, MeshDetail::full).meshes[0].face_sizes.size(), triangles)
            << name;
}

TEST(StructureScenes, are_valid_and_the_same_every_time) {
    for (const std::string& name : structure_scene_names()) {
        const Scene scene = make_structure_scene(name, MeshDetail::reduced);
        validate_scene(scene);
        EXPECT_LE(scene.meshes[0].face_sizes.size(), 20'000u) << name;
        EXPECT_EQ(make_structure_scene(name, MeshDetail::reduced).meshes[0].positions,
                  scene.meshes[0].positions);
    }
    EXPECT_THROW(make_structure_scene("bunny", MeshDetail::full), Error);
}

TEST(StructureScenes, the_hall_has_huge_and_tiny_triangles) {
    const Mesh mesh = make_structure_scene("hall", MeshDetail::full).meshes[0];
    double least = 1e9, most = 0;
    for (size_t k = 0; k < mesh.face_sizes.size(); ++k) {
        const double area = area_of(mesh, k);
        if (area > 0) least = std::min(least, area);
        most = std::max(most, area);
    }
    EXPECT_GT(most / least, 1e6);
}

/// Every edge has a triangle on each side, once corners at one place count as one.
TEST(StructureScenes, the_body_is_closed) {
    const Mesh mesh = make_structure_scene("body", MeshDetail::reduced).meshes[0];
    const auto place = [&](size_t corner) {
        // Sides of the cube meet in points that differ in rounding.
        const Vec3f& p = mesh.positions[mesh.position_indices[corner]];
        return std::array<int, 3>{int(std::lround(p.x * 1e4)), int(std::lround(p.y * 1e4)),
                                  int(std::lround(p.z * 1e4))};
    };
    std::map<std::pair<std::array<int, 3>, std::array<int, 3>>, int> edges;
    for (size_t k = 0; k < mesh.position_indices.size(); k += 3)
        for (size_t side = 0; side < 3; ++side) {
            const auto from = place(k + side), to = place(k + (side + 1) % 3);
            edges[std::minmax(from, to)] += from < to ? 1 : -1;
        }
    for (const auto& [edge, balance] : edges) ASSERT_EQ(balance, 0);
}

} // namespace
} // namespace relief
