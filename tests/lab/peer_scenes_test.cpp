#include "lab/scenes/peer_scenes.h"

#include <gtest/gtest.h>

#include <map>
#include <utility>

#include "math/vec.h"
#include "relief/error.h"
#include "surface/patch/surface.h"

namespace relief {
namespace {

TEST(PeerScenes, are_valid_and_of_the_size_they_say) {
    const std::map<std::string, size_t> patches = {{"rock", 600}, {"rocks", 6000}, {"rock_close", 600}};
    EXPECT_EQ(peer_scene_names().size(), patches.size());
    for (const std::string& name : peer_scene_names()) {
        const Scene scene = make_peer_scene(name, 1, PeerWorld::sky);
        EXPECT_NO_THROW(validate_scene(scene));
        EXPECT_EQ(scene.meshes[0].face_sizes.size(), patches.at(name));
        EXPECT_EQ(scene.meshes[0].positions.size(), patches.at(name) / 600 * 602) << "one corner a place";
        EXPECT_TRUE(scene.environment->texture);
    }
    EXPECT_FALSE(make_peer_scene("rock", 1, PeerWorld::constant).environment->texture);
    EXPECT_THROW(make_peer_scene("rok", 1, PeerWorld::sky), Error);
}

TEST(PeerScenes, are_closed_bodies_that_face_outwards) {
    const Mesh mesh = make_peer_scene("rock", 1, PeerWorld::constant).meshes[0];
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    for (size_t face = 0; face < mesh.face_sizes.size(); ++face) {
        const uint32_t* corner = mesh.position_indices.data() + 4 * face;
        for (int k = 0; k < 4; ++k) ++edges[{corner[k], corner[(k + 1) % 4]}];
        const auto at = [&](int k) { return mesh.positions[corner[k]]; };
        EXPECT_GT(dot(cross(at(1) - at(0), at(2) - at(0)), at(0)), 0) << "face " << face;
    }
    for (const auto& [edge, count] : edges) {
        EXPECT_EQ(count, 1);
        EXPECT_EQ((edges.count({edge.second, edge.first})), 1u);
    }
}

TEST(PeerScenes, have_charts_that_agree_where_they_meet) {
    const Scene scene = make_peer_scene("rock", 1, PeerWorld::constant);
    const Mesh& mesh = scene.meshes[0];
    const Surface surface = make_surface(mesh, &scene.displacements[0], {});
    std::map<uint32_t, Vec3f> moved;
    float longest = 0;
    for (size_t corner = 0; corner < mesh.position_indices.size(); ++corner) {
        const Vec3f move = fetch_displacement(surface.map, 0, mesh.uvs[mesh.uv_indices[corner]]);
        const auto [place, is_new] = moved.emplace(mesh.position_indices[corner], move);
        if (!is_new) EXPECT_LT(length(place->second - move), 1e-4f) << "corner " << corner;
        longest = std::max(longest, length(move));
    }
    EXPECT_GT(longest, 0.1f);
    EXPECT_LT(longest, 0.5f);
}

} // namespace
} // namespace relief
