// Maps turned into other conventions and back, surfaces turned into plain meshes.
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "inspect/findings.h"
#include "math/affine.h"
#include "relief/convert.h"
#include "relief/error.h"
#include "support/sculpt.h"
#include "surface/map/texels.h"
#include "surface/patch/surface.h"

namespace relief::test {
namespace {

constexpr uint32_t kSize = 32;

/// A strip of quads bent into half a tube, with uvs that lie turned and a little apart from the edges; the
/// second half of it is an island of its own, mirrored.
Mesh make_tube() {
    constexpr uint32_t kAround = 8, kAlong = 4;
    Mesh mesh;
    mesh.name = "tube";
    for (uint32_t j = 0; j <= kAlong; ++j)
        for (uint32_t i = 0; i <= kAround; ++i) {
            const float angle = 3.0f * float(i) / kAround;
            mesh.positions.push_back({std::cos(angle), 0.5f * float(j), std::sin(angle)});
        }
    for (uint32_t j = 0; j < kAlong; ++j)
        for (uint32_t i = 0; i < kAround; ++i) {
            mesh.face_sizes.push_back(4);
            for (const auto& [a, b] : {std::pair(i, j), {i, j + 1}, {i + 1, j + 1}, {i + 1, j}}) {
                mesh.position_indices.push_back(b * (kAround + 1) + a);
                mesh.uv_indices.push_back(uint32_t(mesh.uvs.size()));
                const float s = float(a) / kAround, t = float(b) / kAlong;
                if (i < kAround / 2)
                    mesh.uvs.push_back({0.05f + 0.4f * t, 0.1f + 0.7f * 2 * s});
                else
                    mesh.uvs.push_back({0.95f - 0.4f * t, 0.1f + 0.7f * (2 * s - 1)});
            }
        }
    return mesh;
}

Displacement draw_meaning(std::mt19937& random) {
    std::uniform_real_distribution<float> factor(0.5f, 2), middle(-0.5f, 0.5f);
    Displacement map;
    for (size_t c = 2; c > 0; --c) std::swap(map.axes.axis[c], map.axes.axis[random() % (c + 1)]);
    for (int8_t& sign : map.axes.sign) sign = random() % 2 == 0 ? 1 : -1;
    map.scale = {factor(random), -factor(random), factor(random)};
    map.midlevel = {middle(random), middle(random), middle(random)};
    map.flip_v = random() % 2 == 0;
    return map;
}

std::vector<Vec3f> evaluate(const Mesh& mesh, const Displacement& map) {
    constexpr uint8_t kLevel = 4;
    const Surface surface = make_surface(mesh, &map, {});
    std::vector<Vec3f> points;
    for (uint32_t patch = 0; patch < surface.patch_count(); ++patch)
        for (uint32_t j = 0; j <= 1u << kLevel; ++j)
            for (uint32_t i = 0; i <= 1u << kLevel; ++i)
                points.push_back(
                    evaluate_vertex(surface, patch, {kLevel, {kLevel, kLevel, kLevel, kLevel}}, i, j));
    return points;
}

float measure_difference(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
    float largest = 0;
    for (size_t k = 0; k < a.size(); ++k) largest = std::max(largest, length(a[k] - b[k]));
    return largest;
}

TEST(ConvertMap, any_meaning_gives_the_same_surface) {
    std::mt19937 random(3);
    const Mesh plane = make_sculpt_plane();
    const Displacement map = make_map(make_sculpt_texture(kSize));
    const std::vector<Vec3f> reference = evaluate(plane, map);
    for (int k = 0; k < 12; ++k) {
        const Displacement there = convert_map(map, draw_meaning(random));
        EXPECT_LT(measure_difference(reference, evaluate(plane, there)), 2e-6f);
        const Displacement back = convert_map(there, map);
        EXPECT_LT(measure_difference(reference, evaluate(plane, back)), 2e-6f);
        EXPECT_EQ(back.axes, map.axes);
    }
    // The comparison is able to fail.
    Displacement wrong = convert_map(map, draw_meaning(random));
    wrong.axes = map.axes;
    EXPECT_GT(measure_difference(reference, evaluate(plane, wrong)), 0.1f);
}

TEST(ConvertMap, spaces_are_turned_by_the_frames_of_the_mesh_and_back) {
    const Mesh tube = make_tube();
    const Displacement map = make_map(make_sculpt_texture(128));
    Displacement object;
    object.space = DisplacementSpace::object;
    object.axes = {{0, 2, 1}, {1, -1, 1}};
    const Displacement there = convert_map(map, object, &tube);
    EXPECT_EQ(there.space, DisplacementSpace::object);
    const std::vector<Vec3f> reference = evaluate(tube, map);
    // Between texels the frame is blended in the one and the vector in the other.
    EXPECT_LT(measure_difference(reference, evaluate(tube, there)), 0.01f);
    const Displacement back = convert_map(there, map, &tube);
    // There and back all texels under the mesh are what they were.
    EXPECT_LT(measure_difference(reference, evaluate(tube, back)), 1e-4f);
    EXPECT_GT(measure_difference(reference, evaluate(tube, make_map(make_sculpt_texture(128, object.axes)))),
              0.1f);
}

TEST(ConvertMap, frames_are_turned_into_others_and_back) {
    const Mesh tube = make_tube();
    Displacement map = make_map(make_sculpt_texture(128)), relative = map;
    relative.frame = FrameKind::dpdu, relative.lengths = FrameLengths::relative;
    relative.scale = {0.3f, 0.5f, 1};
    const Displacement there = convert_map(map, relative, &tube);
    EXPECT_EQ(there.lengths, FrameLengths::relative);
    const std::vector<Vec3f> reference = evaluate(tube, map);
    EXPECT_LT(measure_difference(reference, evaluate(tube, there)), 0.01f);
    EXPECT_LT(measure_difference(reference, evaluate(tube, convert_map(there, map, &tube))), 1e-4f);
    map.lengths = FrameLengths::relative;
    EXPECT_GT(measure_difference(reference, evaluate(tube, map)), 0.05f);
    EXPECT_THROW(convert_map(map, relative), Error) << "no mesh";
    map.frame = FrameKind::dpdu;
    EXPECT_NO_THROW(convert_map(map, relative));
}

/// A plane on whose upper edge tangents and bitangents point the other way.
Mesh make_turning_plane() {
    Mesh plane = make_sculpt_plane();
    plane.normals = {{0, 0, 1}};
    plane.normal_indices.assign(plane.position_indices.size(), 0);
    for (const uint32_t index : plane.position_indices)
        plane.tangents.push_back({plane.positions[index].y > 0 ? -1.0f : 1.0f, 0, 0, 1});
    return plane;
}

TEST(ConvertMap, frames_that_nearly_collapse_give_bounded_values_and_a_warning) {
    const Mesh plane = make_turning_plane();
    auto texture = make_sculpt_texture(kSize);
    for (size_t k = 0; k < texture->floats.size(); k += 4)
        texture->floats[k] = 0.3f, texture->floats[k + 1] = 0.2f, texture->floats[k + 2] = 0.1f;
    Displacement object = make_map(texture), tangent;
    object.space = DisplacementSpace::object;
    tangent.frame = FrameKind::file;
    std::vector<std::string> warnings;
    const Displacement there = convert_map(object, tangent, &plane, &warnings);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_HAS_PART(warnings[0], "tile 1001: tangent space does not hold the displacement of");
    EXPECT_HAS_PART(warnings[0], "scene units");
    EXPECT_LT(find_largest_displacement(there), length(Vec3f{0.3f, 0.2f, 0.1f}) / 0.25f);
    for (uint32_t y = 0; y < kSize; ++y) {
        const std::array<float, 3> texel = read_texel(*there.tiles[0].texture, 5, y);
        EXPECT_NEAR(texel[2], 0.1f, 1e-5f) << "along the normal nothing is lost, in row " << y;
        const float stretch = std::fabs(1 - 2 * (float(y) + 0.5f) / kSize);
        if (stretch > 0.25f) EXPECT_NEAR(std::fabs(texel[0]) * stretch, 0.3f, 1e-4f) << "row " << y;
    }
    warnings.clear();
    convert_map(make_map(make_sculpt_texture(128)), object, &plane, &warnings);
    const Mesh tube = make_tube();
    tangent.frame = FrameKind::dpdu, tangent.lengths = FrameLengths::relative;
    convert_map(object, tangent, &tube, &warnings);
    EXPECT_TRUE(warnings.empty()) << warnings.front();
}

TEST(ConvertMap, a_height_becomes_a_vector_along_the_normal) {
    auto texture = make_sculpt_texture(kSize);
    texture->channel_count = 1;
    Displacement height = make_map(texture);
    height.type = DisplacementType::height;
    height.midlevel = {0.1f, 0, 0}, height.scale = {2, 1, 1};
    Displacement vectors;
    vectors.axes = {{0, 2, 1}, {1, 1, 1}};
    const Mesh plane = make_sculpt_plane();
    EXPECT_LT(measure_difference(evaluate(plane, height), evaluate(plane, convert_map(height, vectors))),
              1e-6f);
    EXPECT_THROW(convert_map(make_map(make_sculpt_texture(kSize)), height), Error);
}

TEST(ConvertMap, what_cannot_be_turned_is_refused) {
    const Displacement map = make_map(make_sculpt_texture(kSize));
    Displacement object;
    object.space = DisplacementSpace::object;
    EXPECT_THROW(convert_map(map, object), Error) << "no mesh";
    Displacement world;
    world.space = DisplacementSpace::world;
    const Mesh plane = make_sculpt_plane();
    EXPECT_THROW(convert_map(map, world, &plane), Error);
    Displacement flat = map;
    flat.scale.y = 0;
    EXPECT_THROW(convert_map(map, flat), Error);
}

TEST(ConvertMap, the_largest_displacement_is_decoded) {
    auto texture = make_sculpt_texture(2);
    texture->floats.assign(16, 0.5f);
    texture->floats[9] = 0.0f;
    Displacement map = make_map(texture);
    map.midlevel = {0.5f, 0.5f, 0.5f}, map.scale = {1, 3, 1};
    EXPECT_FLOAT_EQ(find_largest_displacement(map), 1.5f);
}

/// Faces beside each edge, by the numbers of its ends.
std::map<std::pair<uint32_t, uint32_t>, int> count_edges(const Mesh& mesh) {
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    for (size_t face = 0; face < mesh.face_sizes.size(); ++face)
        for (size_t k = 0; k < 4; ++k) {
            const uint32_t a = mesh.position_indices[4 * face + k],
                           b = mesh.position_indices[4 * face + (k + 1) % 4];
            ++edges[std::minmax(a, b)];
        }
    return edges;
}

Scene make_scene(const Mesh& mesh, const Displacement& map) {
    Scene scene;
    scene.meshes.push_back(mesh);
    scene.displacements.push_back(map);
    Object object;
    object.mesh = 0, object.displacement = 0;
    scene.objects.push_back(object);
    return scene;
}

TEST(DisplacedMesh, has_the_vertices_of_the_surface_and_shares_them_across_edges_and_seams) {
    constexpr int kLevel = 3;
    const Mesh tube = make_tube();
    const Displacement map = make_map(make_sculpt_texture(kSize));
    const Mesh mesh = make_displaced_mesh(make_scene(tube, map), kLevel);
    EXPECT_EQ(mesh.face_sizes.size(), tube.face_sizes.size() << (2 * kLevel));
    // 8 x 4 patches in a strip, seam or no seam: a grid of 65 x 33 points.
    EXPECT_EQ(mesh.positions.size(), 65u * 33u);
    size_t open = 0;
    for (const auto& [edge, count] : count_edges(mesh)) {
        EXPECT_LE(count, 2);
        open += count == 1;
    }
    EXPECT_EQ(open, 2u * (64 + 32));
    const Surface surface = make_surface(tube, &map, {});
    std::set<std::array<float, 3>> points;
    for (const Vec3f& p : mesh.positions) points.insert({p.x, p.y, p.z});
    for (uint32_t patch = 0; patch < surface.patch_count(); ++patch)
        for (uint32_t k = 0; k <= 1u << kLevel; ++k) {
            const Vec3f p = evaluate_vertex(surface, patch, {kLevel, {kLevel, kLevel, kLevel, kLevel}}, k, 3);
            EXPECT_TRUE(points.count({p.x, p.y, p.z}) == 1);
        }
}

TEST(DisplacedMesh, keeps_uvs_with_their_tiles) {
    Mesh plane = make_sculpt_plane();
    for (Vec2f& uv : plane.uvs) uv.x += 2, uv.y += 1;
    Displacement map = make_map(make_sculpt_texture(kSize));
    map.is_udim = true;
    map.tiles[0].udim = 1013;
    const Mesh mesh = make_displaced_mesh(make_scene(plane, map), 2);
    for (size_t corner = 0; corner < mesh.position_indices.size(); ++corner) {
        const Vec2f& uv = mesh.uvs[mesh.uv_indices[corner]];
        EXPECT_GE(uv.x, 2);
        EXPECT_LE(uv.x, 3);
        EXPECT_GE(uv.y, 1);
    }
    EXPECT_EQ(get_fact(inspect_mesh(mesh), "uv_tiles"), "1013");
}

TEST(DisplacedMesh, is_the_surface_that_is_rendered_gutter_and_all) {
    Mesh plane = make_sculpt_plane();
    for (Vec2f& uv : plane.uvs) uv = {0.25f + 0.5f * uv.x, 0.25f + 0.5f * uv.y};
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = 64, texture->channel_count = 3;
    for (uint32_t k = 0; k < 64 * 64; ++k) {
        const bool is_inside = k % 64 >= 16 && k % 64 < 48 && k / 64 >= 16 && k / 64 < 48;
        texture->floats.insert(texture->floats.end(), {0, 0, is_inside ? 0.1f : -0.3f, 1});
    }
    const Mesh mesh = make_displaced_mesh(make_scene(plane, make_map(texture)), 4);
    for (const Vec3f& p : mesh.positions) ASSERT_NEAR(p.z, 0.1f, 1e-6f);
}

TEST(DisplacedMesh, objects_stand_where_they_stand_and_face_outwards) {
    Scene scene = make_scene(make_sculpt_plane(), make_map(make_sculpt_texture(kSize)));
    scene.objects[0].world_from_object = make_scale({-2, 2, 2});
    scene.objects[0].world_from_object.translation = {10, 0, 0};
    Object plain;
    plain.mesh = 0;
    scene.objects.push_back(plain);
    const Mesh mesh = make_displaced_mesh(scene, 1);
    ASSERT_EQ(mesh.face_sizes.size(), 5u);
    EXPECT_EQ(mesh.positions.size(), 9u + 4u);
    // Mirrored, the first corner lies on the right; turned faces still run counter-clockwise seen from +z.
    const auto at = [&](size_t corner) { return mesh.positions[mesh.position_indices[corner]]; };
    EXPECT_GT(cross(at(1) - at(0), at(2) - at(0)).z, 0);
    EXPECT_NEAR(at(0).x, 12, 0.01f);
}

TEST(DisplacedMesh, points_far_from_the_origin_stay_there) {
    constexpr float kFar = 262144;
    const Displacement map = make_map(make_sculpt_texture(kSize));
    Mesh plane = make_sculpt_plane();
    const Mesh near = make_displaced_mesh(make_scene(plane, map), 1);
    for (Vec3f& p : plane.positions) p.x += kFar;
    for (const float back : {0.0f, -kFar}) {
        Scene scene = make_scene(plane, map);
        scene.objects[0].world_from_object.translation = {back, 0, 0};
        const Mesh far = make_displaced_mesh(scene, 1);
        ASSERT_EQ(far.positions.size(), near.positions.size());
        for (size_t k = 0; k < near.positions.size(); ++k) {
            EXPECT_NEAR(far.positions[k].x, near.positions[k].x + kFar + back, 0.05f) << back;
            EXPECT_NEAR(far.positions[k].z, near.positions[k].z, 1e-5f);
        }
    }
}

TEST(DisplacedMesh, a_level_that_does_not_fit_is_refused) {
    Mesh tube = make_tube();
    for (int k = 0; k < 2; ++k) { // 128 patches of 16 million quads, more than any machine is asked for
        const auto repeat = [](std::vector<uint32_t>& list) {
            const std::vector<uint32_t> once = list;
            list.insert(list.end(), once.begin(), once.end());
        };
        repeat(tube.face_sizes), repeat(tube.position_indices), repeat(tube.uv_indices);
    }
    const Scene scene = make_scene(tube, make_map(make_sculpt_texture(kSize)));
    EXPECT_THROW(make_displaced_mesh(scene, -1), Error);
    EXPECT_THROW(make_displaced_mesh(scene, 13), Error);
    try {
        make_displaced_mesh(scene, 12);
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::out_of_memory);
        EXPECT_HAS_PART(std::string(error.what()), "2147483648 quads");
    }
}

} // namespace
} // namespace relief::test
