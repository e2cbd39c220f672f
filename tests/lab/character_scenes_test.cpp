#include "lab/scenes/character_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "lab/scenes/box_mesh.h"
#include "math/vec.h"
#include "relief/error.h"
#include "surface/patch/surface.h"

namespace relief {
namespace {

using Edge = std::pair<uint32_t, uint32_t>;

/// How often each edge runs in each direction.
std::map<Edge, int> count_edges(const Mesh& mesh) {
    std::map<Edge, int> edges;
    for (size_t corner = 0; corner < mesh.position_indices.size(); ++corner) {
        const size_t next = corner % 4 == 3 ? corner - 3 : corner + 1;
        ++edges[{mesh.position_indices[corner], mesh.position_indices[next]}];
    }
    return edges;
}

float compute_volume(const Mesh& mesh) {
    float volume = 0;
    for (size_t first = 0; first < mesh.position_indices.size(); first += 4) {
        const auto at = [&](size_t k) { return mesh.positions[mesh.position_indices[first + k]]; };
        volume += dot(at(0), cross(at(1), at(2))) + dot(at(0), cross(at(2), at(3)));
    }
    return volume / 6;
}

std::map<uint32_t, size_t> count_valences(const Mesh& mesh) {
    std::map<uint32_t, uint32_t> valences;
    for (const uint32_t position : mesh.position_indices) ++valences[position];
    std::map<uint32_t, size_t> counts;
    for (const auto& [position, valence] : valences) ++counts[valence];
    return counts;
}

/// Parts of the mesh that are joined by shared uvs.
size_t count_islands(const Mesh& mesh) {
    std::vector<uint32_t> parents(mesh.uvs.size());
    std::iota(parents.begin(), parents.end(), 0u);
    const auto find_root = [&](uint32_t k) {
        while (parents[k] != k) k = parents[k] = parents[parents[k]];
        return k;
    };
    for (size_t corner = 0; corner < mesh.uv_indices.size(); ++corner)
        parents[find_root(mesh.uv_indices[corner])] = find_root(mesh.uv_indices[corner / 4 * 4]);
    std::set<uint32_t> roots;
    for (const uint32_t k : mesh.uv_indices) roots.insert(find_root(k));
    return roots.size();
}

TEST(CharacterScenes, are_valid_and_smooth_and_name_no_level) {
    for (const std::string& name : character_scene_names()) {
        const Scene scene = make_character_scene(name, CharacterDetail::reduced);
        EXPECT_NO_THROW(validate_scene(scene)) << name;
        EXPECT_EQ(scene.meshes.size(), 1u) << name;
        EXPECT_EQ(scene.meshes[0].subdivision, Subdivision{.scheme = SubdivisionScheme::catmark}) << name;
        EXPECT_TRUE(scene.environment->texture) << name;
        EXPECT_TRUE(scene.lights.empty()) << name;
        for (const Displacement& map : scene.displacements) {
            EXPECT_EQ(map.type, DisplacementType::vector) << name;
            EXPECT_EQ(map.space, DisplacementSpace::object) << name;
        }
    }
    EXPECT_THROW(make_character_scene("bod", CharacterDetail::reduced), Error);
}

TEST(CharacterScenes, have_the_quads_and_the_maps_that_they_promise) {
    const Scene body = make_character_scene("body", CharacterDetail::full);
    EXPECT_EQ(body.meshes[0].face_sizes.size(), 12992u);
    ASSERT_EQ(body.displacements.size(), 1u);
    EXPECT_EQ(body.displacements[0].tiles[0].texture->width, 1024u);
    EXPECT_EQ(make_character_scene("body", CharacterDetail::reduced).meshes[0].face_sizes.size(), 812u);
    const Scene head = make_character_scene("head", CharacterDetail::full);
    EXPECT_EQ(head.meshes[0].face_sizes.size(), 21600u);
    ASSERT_EQ(head.displacements[0].tiles.size(), 4u);
    EXPECT_TRUE(head.displacements[0].is_udim);
    EXPECT_EQ(head.displacements[0].tiles[3].udim, 1004);
    EXPECT_EQ(head.displacements[0].tiles[3].texture->height, 512u);
}

TEST(CharacterScenes, are_closed_quads_around_a_volume) {
    for (const std::string name : {"body", "head"}) {
        const Mesh mesh = make_character_scene(name, CharacterDetail::reduced).meshes[0];
        for (const uint32_t size : mesh.face_sizes) ASSERT_EQ(size, 4u);
        const std::map<Edge, int> edges = count_edges(mesh);
        for (const auto& [edge, count] : edges) {
            EXPECT_EQ(count, 1) << name;
            EXPECT_EQ((edges.count({edge.second, edge.first})), 1u) << name;
        }
        // Of a sphere; points at which two fans of faces meet would be missing.
        EXPECT_EQ(mesh.positions.size() + mesh.face_sizes.size(), edges.size() / 2 + 2) << name;
        EXPECT_GT(compute_volume(mesh), 0.01f) << name;
    }
}

TEST(CharacterScenes, body_has_poles_and_closed_loops_of_creases) {
    const Mesh mesh = make_character_scene("body", CharacterDetail::full).meshes[0];
    std::map<uint32_t, size_t> valences = count_valences(mesh);
    EXPECT_GT(valences[3], 30u);
    EXPECT_GT(valences[5], 20u);
    EXPECT_GT(valences[4], 9 * mesh.positions.size() / 10);
    std::map<uint32_t, int> ends;
    std::set<float> sharpnesses;
    const std::map<Edge, int> edges = count_edges(mesh);
    for (const Crease& crease : mesh.creases) {
        ++ends[crease.first], ++ends[crease.second];
        sharpnesses.insert(crease.sharpness);
        EXPECT_EQ((edges.count({crease.first, crease.second})), 1u);
    }
    for (const auto& [position, count] : ends) EXPECT_EQ(count, 2) << position;
    EXPECT_EQ(sharpnesses, (std::set<float>{1.2f, 2.5f, kInfiniteSharpness}));
}

TEST(CharacterScenes, uvs_lie_in_islands_on_their_tiles_without_overlap) {
    for (const auto& [name, islands, tiles] :
         {std::tuple{std::string("body"), 25u, 1u}, {std::string("head"), 6u, 4u}}) {
        const Mesh mesh = make_character_scene(name, CharacterDetail::reduced).meshes[0];
        EXPECT_EQ(count_islands(mesh), islands) << name;
        std::set<int> used;
        std::set<std::pair<int, int>> taken; // middles of faces on a grid as fine as the faces
        for (size_t first = 0; first < mesh.uv_indices.size(); first += 4) {
            Vec2f middle;
            for (size_t k = 0; k < 4; ++k) middle = middle + mesh.uvs[mesh.uv_indices[first + k]] * 0.25f;
            used.insert(int(std::floor(middle.x)));
            EXPECT_TRUE(taken.insert({int(middle.x * 2048), int(middle.y * 2048)}).second) << name;
        }
        EXPECT_EQ(used.size(), tiles) << name;
        EXPECT_EQ(*used.rbegin(), int(tiles) - 1) << name;
    }
}

/// Rectangles of sides may touch, but not overlap.
TEST(BoxMesh, hides_the_quads_where_boxes_touch) {
    const std::vector<LatticeBox> boxes = {{{0, 0, 0}, {3, 3, 3}, 1}, {{1, 3, 1}, {2, 5, 2}, 1}};
    const BoxMesh body = make_box_mesh(boxes, 2, [](size_t box, int side) {
        return UvRectangle{{0.1f * float(side), 0.2f * float(box)}, {0.1f, 0.1f}};
    });
    EXPECT_EQ(body.mesh.face_sizes.size(), size_t(4 * (6 * 9 - 1 + 4 * 2 + 1)));
    EXPECT_NEAR(compute_volume(body.mesh), 27 + 2, 1e-3f);
    const SurfaceFinder finder(body);
    EXPECT_LT(length(finder.find({0.05f, 0.05f}).position - Vec3f{0, 1.5f, 1.5f}), 1.6f);
    EXPECT_GT(length(finder.find({0.55f, 0.05f}).normal), 0.99f) << "beside the part that is covered";
}

TEST(CharacterScenes, maps_displace_a_little_and_agree_where_islands_meet) {
    for (const std::string name : {"body", "head"}) {
        const Scene scene = make_character_scene(name, CharacterDetail::full);
        Mesh mesh = scene.meshes[0];
        mesh.subdivision = {}; // only its map is asked for
        const Surface surface = make_surface(mesh, &scene.displacements[0], {});
        std::map<uint32_t, Vec3f> moved;
        float longest = 0, worst = 0;
        for (size_t corner = 0; corner < mesh.position_indices.size(); ++corner) {
            const Vec2f uv = mesh.uvs[mesh.uv_indices[corner]];
            const float tile = std::floor(uv.x);
            const Vec3f move = fetch_displacement(surface.map, uint8_t(tile), {uv.x - tile, uv.y});
            const auto [place, is_new] = moved.emplace(mesh.position_indices[corner], move);
            if (!is_new) worst = std::max(worst, length(place->second - move));
            longest = std::max(longest, length(move));
        }
        EXPECT_GT(longest, 0.01f) << name;
        EXPECT_LT(longest, 0.08f) << name;
        EXPECT_LT(worst, 0.12f * longest) << name;
    }
}

TEST(CharacterScenes, are_the_same_each_time) {
    for (const std::string& name : character_scene_names()) {
        const Scene a = make_character_scene(name, CharacterDetail::reduced);
        const Scene b = make_character_scene(name, CharacterDetail::reduced);
        EXPECT_EQ(a.meshes[0].positions, b.meshes[0].positions) << name;
        EXPECT_EQ(a.meshes[0].uvs, b.meshes[0].uvs) << name;
        for (size_t map = 0; map < a.displacements.size(); ++map)
            for (size_t tile = 0; tile < a.displacements[map].tiles.size(); ++tile)
                EXPECT_EQ(a.displacements[map].tiles[tile].texture->halves,
                          b.displacements[map].tiles[tile].texture->halves)
                    << name;
    }
}

TEST(CharacterScenes, crowd_shares_a_mesh_and_no_map) {
    const Scene scene = make_character_scene("crowd", CharacterDetail::reduced);
    ASSERT_EQ(scene.objects.size(), 20u);
    std::set<uint32_t> maps;
    std::set<std::vector<uint16_t>> texels;
    for (const Object& object : scene.objects) {
        EXPECT_EQ(object.mesh, 0u);
        maps.insert(object.displacement);
        texels.insert(scene.displacements[object.displacement].tiles[0].texture->halves);
    }
    EXPECT_EQ(maps.size(), 20u);
    EXPECT_EQ(texels.size(), 20u);
}

} // namespace
} // namespace relief
