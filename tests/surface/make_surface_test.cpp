#include <gtest/gtest.h>

#include <algorithm>

#include "surface/test_scenes.h"

namespace relief {

namespace {

using test::catch_message;

Displacement make_flat_map() { return test::make_displacement(test::make_constant(4, 4, {0, 0, 0})); }

std::string try_mesh(const Mesh& mesh) {
    return catch_message([&] {
        const Displacement displacement = make_flat_map();
        make_surface(mesh, &displacement, {});
    });
}

TEST(MakeSurface, keeps_corners_and_joins_shared_vertices) {
    const Mesh mesh = test::make_random_grid(3, 2, 0, 5);
    const Displacement displacement = make_flat_map();
    const Surface surface = make_surface(mesh, &displacement, {});
    EXPECT_EQ(surface.patch_count(), 6u);
    EXPECT_EQ(surface.positions.size(), 12u);
    EXPECT_TRUE(surface.copies.empty());
    EXPECT_TRUE(surface.overrides.empty());
    for (uint32_t corner = 0; corner < 24; ++corner)
        EXPECT_EQ(surface.position(surface.quads[corner / 4].vertex[corner % 4]),
                  mesh.positions[mesh.position_indices[corner]]);
}

TEST(MakeSurface, refinement_of_polygons_closes_every_edge) {
    const Mesh mesh = test::make_pyramid();
    const Displacement displacement = make_flat_map();
    const Surface surface = make_surface(mesh, &displacement, {});
    EXPECT_EQ(surface.patch_count(), 16u);
    std::map<std::pair<uint32_t, uint32_t>, int> uses;
    for (const Quad quad : surface.quads)
        for (int k = 0; k < 4; ++k)
            ++uses[{surface.dominant(quad.vertex[k]), surface.dominant(quad.vertex[(k + 1) & 3])}];
    for (const auto& [edge, count] : uses) {
        EXPECT_EQ(count, 1);
        EXPECT_EQ(uses.count(std::pair(edge.second, edge.first)), 1u);
    }
    EXPECT_EQ(surface.position(surface.quads[0].vertex[2]), (Vec3f{0.5f, 0.5f, 0}));
    EXPECT_EQ(surface.quads[0].vertex[0], 0u);
}

TEST(MakeSurface, joins_points_that_an_exporter_took_apart) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0},     {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                      {1, -0.0f, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}};
    test::add_face(mesh, {0, 1, 2, 3}, {{0, 0}, {0.5f, 0}, {0.5f, 1}, {0, 1}});
    test::add_face(mesh, {4, 5, 6, 7}, {{0.5f, 0}, {1, 0}, {1, 1}, {0.5f, 1}});
    const Displacement displacement = make_flat_map();
    EXPECT_EQ(make_surface(mesh, &displacement, {}).positions.size(), 6u);
}

TEST(MakeSurface, seams_take_the_vertices_of_the_lower_patch) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}};
    test::add_face(mesh, {0, 1, 2, 3}, {{0, 0}, {0.4f, 0}, {0.4f, 1}, {0, 1}});
    test::add_face(mesh, {1, 4, 5, 2}, {{0.6f, 0}, {1, 0}, {1, 1}, {0.6f, 1}});
    const Displacement displacement = make_flat_map();
    const Surface surface = make_surface(mesh, &displacement, {});
    EXPECT_EQ(surface.positions.size(), 6u);
    EXPECT_EQ(surface.vertex_count(), 8u);
    for (uint32_t v = 0; v < 8; ++v) {
        EXPECT_LE(surface.dominant(v), v);
        EXPECT_LT(surface.dominant(v), 6u);
    }
    EXPECT_TRUE(surface.is_seam(0, 1));
    EXPECT_TRUE(surface.is_seam(1, 3));
    EXPECT_FALSE(surface.is_seam(0, 0));
    const Surface::EdgeLine a = surface.edge_line(0, 1), b = surface.edge_line(1, 3);
    EXPECT_EQ(a.first, surface.quads[0].vertex[1]);
    EXPECT_EQ(b.first, a.first);
    EXPECT_EQ(b.second, a.second);
    EXPECT_NE(a.is_reversed, b.is_reversed);
    EXPECT_EQ(surface.dominant(surface.quads[1].vertex[0]), surface.quads[0].vertex[1]);
}

TEST(MakeSurface, udim_tiles_displace_their_own_patches_only) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}, {3, 0, 0}, {3, 1, 0}};
    test::add_face(mesh, {0, 1, 2, 3}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    test::add_face(mesh, {1, 4, 5, 2}, {{1, 0}, {2, 0}, {2, 1}, {1, 1}});
    test::add_face(mesh, {4, 6, 7, 5}, {{2, 1}, {3, 1}, {3, 2}, {2, 2}});
    Displacement displacement = test::make_displacement(test::make_constant(2, 2, {0, 0, 1}));
    displacement.is_udim = true;
    displacement.tiles.push_back({1013, test::make_constant(2, 2, {0, 0, 3})});
    const Surface surface = make_surface(mesh, &displacement, {});
    const PatchLevels levels{1, {1, 1, 1, 1}};
    EXPECT_FLOAT_EQ(evaluate_vertex(surface, 0, levels, 1, 1).z, 1);
    EXPECT_FLOAT_EQ(evaluate_vertex(surface, 1, levels, 1, 1).z, 0);
    EXPECT_FLOAT_EQ(evaluate_vertex(surface, 2, levels, 1, 1).z, 3);
    EXPECT_EQ(surface.uvs[surface.quads[2].vertex[0]], (Vec2f{0, 0}));
}

TEST(MakeSurface, maps_have_hundreds_of_tiles) {
    constexpr int kTiles = 700;
    Mesh mesh;
    Displacement displacement;
    displacement.is_udim = true;
    for (int k = 0; k < kTiles; ++k) {
        const float u = float(k % 10), v = float(k / 10);
        const uint32_t first = uint32_t(mesh.positions.size());
        for (const Vec2f& p :
             {Vec2f{u, v}, Vec2f{u + 0.9f, v}, Vec2f{u + 0.9f, v + 0.9f}, Vec2f{u, v + 0.9f}})
            mesh.positions.push_back({p.x, p.y, 0});
        test::add_face(mesh, {first, first + 1, first + 2, first + 3},
                       {{u, v}, {u + 0.9f, v}, {u + 0.9f, v + 0.9f}, {u, v + 0.9f}});
        // In falling order, and the one with number 300 is missing.
        const int number = kTiles - 1 - k;
        if (number != 300)
            displacement.tiles.push_back(
                {1001 + number, test::make_constant(1, 1, {0, 0, float(number + 1)})});
    }
    const Surface surface = make_surface(mesh, &displacement, {});
    for (uint32_t k = 0; k < uint32_t(kTiles); ++k)
        EXPECT_FLOAT_EQ(evaluate_vertex(surface, k, {1, {1, 1, 1, 1}}, 1, 1).z, k == 300 ? 0 : float(k + 1));
}

TEST(MakeSurface, world_space_maps_go_through_the_inverse_of_the_object) {
    const Affine world_from_object = compose(make_rotation_degrees({0, 90, 0}), make_scale({2, 2, 2}));
    Displacement displacement = test::make_displacement(test::make_constant(2, 2, {0, 1, 4}));
    displacement.space = DisplacementSpace::world;
    const Surface surface =
        make_surface(test::make_plane(), &displacement, {*invert(world_from_object), nullptr, {}, {}});
    const Vec3f base{0.5f, 0.5f, 0};
    const Vec3f moved = evaluate_vertex(surface, 0, {1, {1, 1, 1, 1}}, 1, 1);
    const Vec3f difference =
        transform_point(world_from_object, moved) - transform_point(world_from_object, base);
    EXPECT_NEAR(length(difference - Vec3f{0, 1, 4}), 0, 1e-5f);
}

TEST(MakeSurface, axes_midlevel_and_scale_decode_each_channel) {
    Displacement displacement = test::make_displacement(test::make_constant(2, 2, {0.75f, 0.5f, 0}));
    displacement.axes.axis = {2, 0, 1};
    displacement.axes.sign = {1, -1, 1};
    displacement.midlevel = {0.5f, 0.25f, 0};
    displacement.scale = {2, 3, 4};
    const Surface surface = make_surface(test::make_plane(), &displacement, {});
    EXPECT_EQ(fetch_displacement(surface.map, 0, {0.3f, 0.6f}), (Vec3f{-0.75f, 0, 0.5f}));
    displacement.type = DisplacementType::height;
    const Surface height = make_surface(test::make_plane(), &displacement, {});
    EXPECT_EQ(fetch_displacement(height.map, 0, {0.3f, 0.6f}), (Vec3f{0, 0, 0.5f}));
}

TEST(MakeSurface, rows_of_the_map_start_at_v_1_unless_flipped_and_wrap_as_asked) {
    auto texture = test::make_constant(2, 2, {0, 0, 0});
    for (int k = 0; k < 4; ++k) texture->floats[4 * k] = float(k + 1); // 1 2 above 3 4
    Displacement displacement = test::make_displacement(texture);
    const auto fetch = [&](const Vec2f& uv, WrapMode wrap) {
        displacement.wrap = wrap;
        return fetch_displacement(make_surface(test::make_plane(), &displacement, {}).map, 0, uv).x;
    };
    EXPECT_EQ(fetch({0.25f, 0.75f}, WrapMode::clamp), 1);
    EXPECT_EQ(fetch({0.5f, 0.5f}, WrapMode::clamp), 2.5f);
    EXPECT_EQ(fetch({-3, 0.75f}, WrapMode::clamp), 1);
    EXPECT_EQ(fetch({-0.25f, 0.75f}, WrapMode::repeat), 2);
    EXPECT_EQ(fetch({-0.25f, 0.75f}, WrapMode::mirror), 1);
    EXPECT_EQ(fetch({-0.75f, 0.75f}, WrapMode::mirror), 2);
    EXPECT_EQ(fetch({1.75f, 0.75f}, WrapMode::mirror), 1);
    EXPECT_EQ(fetch({1.5f, 0.75f}, WrapMode::black), 0);
    EXPECT_EQ(fetch({1, 0.75f}, WrapMode::black), 1);
    displacement.flip_v = true;
    EXPECT_EQ(fetch({0.25f, 0.75f}, WrapMode::clamp), 3);
}

TEST(MakeSurface, half_texels_read_as_the_floats_they_stand_for) {
    auto texture = std::make_shared<Texture>();
    texture->width = 1, texture->height = 1;
    texture->halves = {0xbc00, 0x3555, 0x0001, 0};
    const Displacement displacement = test::make_displacement(texture);
    const Surface surface = make_surface(test::make_plane(), &displacement, {});
    EXPECT_EQ(fetch_displacement(surface.map, 0, {0.5f, 0.5f}), (Vec3f{-1, 1365 * 0x1p-12f, 0x1p-24f}));
}

TEST(MakeSurface, plain_meshes_keep_triangles_and_quads_and_cut_the_rest) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 0.5f, 0}, {0, 2, 0}, {0, 0, 1}};
    test::add_face(mesh, {0, 1, 2, 3, 4}, {});
    test::add_face(mesh, {0, 1, 5}, {});
    test::add_face(mesh, {0, 1, 2, 4}, {});
    test::add_face(mesh, {0, 1, 2, 3}, {});
    const Surface surface = make_surface(mesh, nullptr, {});
    ASSERT_EQ(surface.patch_count(), 7u);
    EXPECT_TRUE(surface.frames.empty());
    EXPECT_FALSE(surface.quads[4].is_triangle());
    float area = 0;
    for (uint32_t patch = 0; patch < 3; ++patch) {
        const Quad quad = surface.quads[patch];
        ASSERT_TRUE(quad.is_triangle());
        const Vec3f& p = surface.position(quad.vertex[0]);
        const float z = cross(surface.position(quad.vertex[1]) - p, surface.position(quad.vertex[2]) - p).z;
        EXPECT_GT(z, 0);
        area += z / 2;
    }
    EXPECT_FLOAT_EQ(area, 2.5f);
}

TEST(MakeSurface, bad_meshes_are_refused_with_file_mesh_face_and_hint) {
    Mesh mesh = test::make_plane();
    mesh.position_indices[2] = 9;
    EXPECT_EQ(try_mesh(mesh),
              "plane.obj: mesh 'plane', face 0: position index 9 is out of range, there are 4 (write the "
              "mesh again)");
    mesh = test::make_plane();
    mesh.positions[1].y = std::nanf("");
    EXPECT_NE(try_mesh(mesh).find("face 0: position 1 is not finite"), std::string::npos);
    mesh = test::make_plane();
    mesh.uvs[3].x = INFINITY;
    EXPECT_NE(try_mesh(mesh).find("face 0: uv 3 is not finite"), std::string::npos);
    mesh = test::make_plane();
    mesh.uv_indices.clear();
    EXPECT_NE(try_mesh(mesh).find("plane.obj: mesh 'plane': mesh has no uvs"), std::string::npos);
    mesh = test::make_plane();
    mesh.positions = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}};
    EXPECT_EQ(
        try_mesh(mesh),
        "plane.obj: mesh 'plane', face 0: face has zero area (remove degenerate faces from the mesh: no "
        "other is left)");
    EXPECT_NE(catch_message([&] { make_surface(mesh, nullptr, {}); }).find("zero area"), std::string::npos);
    std::fill(mesh.position_indices.begin(), mesh.position_indices.end(),
              0u); // the last face, all corners in one point
    EXPECT_NE(catch_message([&] { make_surface(mesh, nullptr, {}); }).find("zero area"), std::string::npos);
    mesh = test::make_plane();
    mesh.position_indices.pop_back();
    EXPECT_NE(try_mesh(mesh).find("there are 3 position indices"), std::string::npos);
    mesh = test::make_plane();
    mesh.uvs[1].x = 9e5f;
    const Displacement wide = test::make_displacement(test::make_constant(4096, 1, {0, 0, 0}));
    EXPECT_NE(catch_message([&] { make_surface(mesh, &wide, {}); }).find("too far out"), std::string::npos);
}

TEST(MakeSurface, bad_maps_are_refused_with_file_pixel_and_hint) {
    const Mesh mesh = test::make_plane();
    auto texture = test::make_noise(20, 10, 1, 3);
    texture->floats[4 * (20 * 7 + 11) + 1] = std::nanf("");
    Displacement displacement = test::make_displacement(texture);
    const auto try_map = [&] { return catch_message([&] { make_surface(mesh, &displacement, {}); }); };
    EXPECT_EQ(try_map(), "noise.exr, pixel (11, 7): map holds NaN in channel G (repair the map)");
    texture->floats[4 * (20 * 7 + 11) + 1] = INFINITY;
    EXPECT_NE(try_map().find("pixel (11, 7): map holds infinity"), std::string::npos);
    displacement = test::make_displacement(test::make_constant(1, 1, {1e30f, 0, 0}));
    EXPECT_NE(try_map().find("displacement 'map'"), std::string::npos);
    displacement = test::make_displacement(std::make_shared<Texture>());
    EXPECT_NE(try_map().find("0 x 0 texels"), std::string::npos);
    displacement.tiles.clear();
    EXPECT_NE(try_map().find("has no map"), std::string::npos);
}

TEST(MakeSurface, collapsed_edges_count_as_triangles) {
    Mesh mesh = test::make_plane();
    mesh.positions[3] = mesh.positions[2];
    const Displacement displacement = make_flat_map();
    EXPECT_EQ(make_surface(mesh, &displacement, {}).patch_count(), 3u);
}

TEST(PyramidCache, shares_one_pyramid_a_texture) {
    PyramidCache pyramids;
    const Displacement displacement = make_flat_map();
    const Surface a = make_surface(test::make_plane(), &displacement, {{}, &pyramids, {}, {}});
    const Surface b = make_surface(test::make_plane(), &displacement, {{}, &pyramids, {}, {}});
    EXPECT_EQ(a.map.tiles[0].pyramid, b.map.tiles[0].pyramid);
}

} // namespace

} // namespace relief
