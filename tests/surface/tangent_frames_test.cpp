// Which frames a displacement goes through: MikkTSpace's, dP/du's, the file's; of unit or of raw length.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "formulas/frame.h"
#include "surface/mesh/corner_tangents.h"
#include "surface/mesh/mikk_tangents.h"
#include "surface/mesh/vertex_frames.h"
#include "surface/mikk_reference.h"
#include "surface/smooth_shapes.h"
#include "surface/test_scenes.h"

namespace relief {
namespace {

constexpr float kPacked = 4e-4f; // of a unit tangent in 31 bits

Displacement make_map(FrameKind frame, FrameLengths lengths = FrameLengths::absolute,
                      const Vec3f& value = {0.25f, 0.5f, 0.125f}) {
    Displacement displacement = test::make_displacement(test::make_constant(4, 4, value));
    displacement.frame = frame, displacement.lengths = lengths;
    return displacement;
}

Vec3f to_vector(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

/// The mesh of mikk_reference.h, with Blender's normals.
Mesh make_reference_mesh() {
    Mesh mesh;
    mesh.name = "reference", mesh.source = "reference.obj";
    for (const auto& position : test::kMikkPositions) mesh.positions.push_back(to_vector(position));
    mesh.face_sizes.assign(std::begin(test::kMikkFaceSizes), std::end(test::kMikkFaceSizes));
    for (const test::MikkCorner& corner : test::kMikkCorners) {
        mesh.position_indices.push_back(corner.point);
        mesh.uv_indices.push_back(uint32_t(mesh.uvs.size()));
        mesh.uvs.push_back({corner.uv[0], corner.uv[1]});
        mesh.normals.push_back(to_vector(corner.normal));
    }
    mesh.normal_indices = mesh.uv_indices;
    return mesh;
}

TEST(MikkTangents, are_those_of_blender) {
    Polygons polygons = make_polygons(make_reference_mesh(), Welding::joined_points);
    add_mikk_tangents(polygons, {}, FrameLengths::absolute);
    ASSERT_EQ(polygons.tangents.size(), std::size(test::kMikkCorners));
    for (size_t k = 0; k < polygons.tangents.size(); ++k) {
        const std::array<float, 4>& found = polygons.tangents[k];
        EXPECT_LT(length(Vec3f{found[0], found[1], found[2]} - to_vector(test::kMikkCorners[k].tangent)),
                  2e-5f)
            << k;
        EXPECT_EQ(found[3], test::kMikkCorners[k].sign) << k;
    }
}

/// Each corner of the mesh is the first of a quad of its refined surface.
TEST(MikkTangents, of_a_surface_are_those_of_blender_with_its_normals_and_with_our_own) {
    for (const FrameKind kind : {FrameKind::mikk, FrameKind::file}) {
        const Displacement displacement = make_map(kind);
        const Surface surface = make_surface(make_reference_mesh(), &displacement, {});
        ASSERT_EQ(surface.patch_count(), std::size(test::kMikkCorners));
        for (uint32_t k = 0; k < surface.patch_count(); ++k) {
            const test::MikkCorner& corner = test::kMikkCorners[k];
            const Vec3f normal = to_vector(corner.normal), tangent = to_vector(corner.tangent);
            const Frame frame = surface.frame(surface.quads[k].vertex[0]);
            EXPECT_LT(length(frame.n - normal), 1e-4f) << k;
            EXPECT_LT(length(frame.t - tangent), kPacked) << k;
            EXPECT_LT(length(frame.b - cross(normal, tangent) * corner.sign), kPacked) << k;
        }
    }
}

/// Two quads that touch in a point alone, where they have the same uv, turned by a right angle.
TEST(MikkTangents, of_fans_that_do_not_join_at_an_edge_stay_apart) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {-1, 0, 0}, {-1, -1, 0}, {0, -1, 0}};
    test::add_face(mesh, {0, 1, 2, 3}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    test::add_face(mesh, {0, 4, 5, 6}, {{0, 0}, {0, 1}, {-1, 1}, {-1, 0}});
    const Displacement displacement = make_map(FrameKind::mikk);
    const Surface surface = make_surface(mesh, &displacement, {});
    EXPECT_EQ(surface.frame(surface.quads[0].vertex[0]).t, (Vec3f{1, 0, 0}));
    EXPECT_EQ(surface.frame(surface.quads[1].vertex[0]).t, (Vec3f{0, 1, 0}));
}

/// One half of the quad has no area on the map: it follows the other.
TEST(MikkTangents, come_from_the_half_of_a_quad_that_has_uvs) {
    Mesh mesh = test::make_plane();
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {2, 2}};
    const Displacement displacement = make_map(FrameKind::mikk);
    const Surface surface = make_surface(mesh, &displacement, {});
    for (const uint32_t vertex : surface.quads[0].vertex) {
        EXPECT_EQ(surface.frame(vertex).t, (Vec3f{1, 0, 0}));
        EXPECT_EQ(surface.frame(vertex).b, (Vec3f{0, 1, 0}));
    }
}

/// The halves of the quad turn their uvs against each other; `turn` says which of them comes first.
TEST(MikkTangents, of_a_quad_lie_the_way_round_of_its_larger_half) {
    for (const uint32_t turn : {0u, 1u})
        for (const float sign : {1.0f, -1.0f}) {
            const Vec2f uvs[4] = {{0, 0}, {sign, 0}, {sign, 1}, {1.2f * sign, 0.5f}};
            Mesh mesh = test::make_plane();
            for (uint32_t k = 0; k < 4; ++k) {
                mesh.position_indices[k] = (k + turn) % 4;
                mesh.uvs[k] = uvs[(k + turn) % 4];
            }
            const Displacement displacement = make_map(FrameKind::mikk);
            const Surface surface = make_surface(mesh, &displacement, {});
            for (const uint32_t vertex : surface.quads[0].vertex) {
                const Frame frame = surface.frame(vertex);
                EXPECT_NEAR(dot(frame.b, cross(frame.n, frame.t)), sign, 1e-6f) << turn;
            }
        }
}

TEST(MikkTangents, on_a_smooth_base_lie_in_the_planes_of_its_normals) {
    const Displacement mikk = make_map(FrameKind::mikk), dpdu = make_map(FrameKind::dpdu);
    const Mesh mesh = test::make_shape(test::Shape::grid);
    const Surface a = make_surface(mesh, &mikk, {}), b = make_surface(mesh, &dpdu, {});
    ASSERT_EQ(a.vertex_count(), b.vertex_count());
    float apart = 0;
    for (uint32_t vertex = 0; vertex < a.vertex_count(); ++vertex) {
        EXPECT_EQ(a.frame(vertex).n, b.frame(vertex).n);
        apart = std::max(apart, length(a.frame(vertex).t - b.frame(vertex).t));
    }
    EXPECT_GT(apart, 0);
    EXPECT_LT(apart, 0.25f);
}

/// In the order in which the quads name their vertices.
std::vector<PackedFrame> list_frames(const Surface& surface) {
    std::vector<PackedFrame> frames;
    std::vector<bool> is_listed(surface.vertex_count());
    for (const Quad quad : surface.quads)
        for (const uint32_t vertex : quad.vertex) {
            if (!is_listed[vertex]) frames.push_back(surface.frames[vertex]);
            is_listed[vertex] = true;
        }
    return frames;
}

/// As they were before there was a choice.
TEST(DerivativeFrames, keep_their_bits) {
    const Displacement displacement = make_map(FrameKind::dpdu);
    const PackedFrame expected[] = {
        {0xef34f745u, 0x1d4798f9u}, {0x12b4f192u, 0x2a289851u}, {0x22fd1f3bu, 0xfb24b00bu},
        {0xf344f162u, 0x126e82e5u}, {0xf344f162u, 0x0fa06064u}, {0x2758d525u, 0x061641aeu},
        {0x19bc0a09u, 0x0cfa7fa2u}, {0xef34f745u, 0xf5406daau}, {0xff06d7aau, 0xf98052f6u},
        {0x12b4f192u, 0xe7b255d6u}, {0xebd4f0ccu, 0xf89c68fcu}, {0xed860d6cu, 0xe962795eu}};
    const std::vector<PackedFrame> frames =
        list_frames(make_surface(test::make_random_grid(2, 2, 0.5f, 3), &displacement, {}));
    ASSERT_EQ(frames.size(), std::size(expected));
    for (size_t k = 0; k < std::size(expected); ++k) {
        EXPECT_EQ(frames[k].normal, expected[k].normal);
        EXPECT_EQ(frames[k].tangent, expected[k].tangent);
    }
    std::vector<Mesh> meshes = {test::make_pyramid()};
    for (uint32_t seed = 6; seed-- > 0;) {
        meshes.insert(meshes.begin(), test::make_random_grid(5, 4, 0.2f * float(seed), seed));
        meshes[0].subdivision.scheme = seed < 3 ? SubdivisionScheme::none : SubdivisionScheme::catmark;
        meshes[0].subdivision.level = 1;
    }
    uint64_t hash = 0;
    for (const Mesh& mesh : meshes)
        for (const PackedFrame& frame : list_frames(make_surface(mesh, &displacement, {})))
            hash = (hash ^ (uint64_t(frame.normal) << 32 | frame.tangent)) * 0x100000001b3ull;
    EXPECT_EQ(hash, 0x9c9754818f2e5528ull);
}

/// A cube with the normals of its faces.
Mesh make_hard_cube() {
    Mesh mesh = test::make_cube();
    mesh.source = "cube.obj";
    mesh.normals = {{0, 0, -1}, {0, 0, 1}, {0, -1, 0}, {0, 1, 0}, {-1, 0, 0}, {1, 0, 0}};
    for (uint32_t face = 0; face < 6; ++face) mesh.normal_indices.insert(mesh.normal_indices.end(), 4, face);
    return mesh;
}

/// Edges that two patches share have the same samples in both.
void expect_closed(const Surface& surface) {
    std::map<std::pair<uint32_t, uint32_t>, std::vector<std::vector<Vec3f>>> edges;
    const PatchLevels levels{3, {3, 3, 3, 3}};
    for (uint32_t patch = 0; patch < surface.patch_count(); ++patch)
        for (int k = 0; k < 4; ++k) {
            const Quad quad = surface.quads[patch];
            const uint32_t a = surface.dominant(quad.vertex[size_t(k)]),
                           b = surface.dominant(quad.vertex[size_t(k + 1) & 3]);
            std::vector<Vec3f> points = test::evaluate_edge(surface, patch, levels, k);
            if (b < a) std::reverse(points.begin(), points.end());
            edges[std::minmax(a, b)].push_back(std::move(points));
        }
    for (const auto& [ends, sides] : edges) {
        ASSERT_EQ(sides.size(), 2u);
        EXPECT_EQ(sides[0], sides[1]) << ends.first << ", " << ends.second;
    }
}

TEST(FileFrames, move_each_side_of_a_hard_edge_along_its_own_normal_and_stay_closed) {
    const Mesh mesh = make_hard_cube();
    for (const DisplacementType type : {DisplacementType::height, DisplacementType::vector}) {
        Displacement displacement = make_map(FrameKind::file, FrameLengths::absolute, {0.5f, 0.5f, 0.5f});
        displacement.type = type;
        const Surface surface = make_surface(mesh, &displacement, {});
        ASSERT_EQ(surface.patch_count(), 6u);
        for (uint32_t face = 0; face < 6; ++face) {
            const Vec3f p = evaluate_vertex(surface, face, {1, {1, 1, 1, 1}}, 1, 1);
            EXPECT_NEAR(dot(p, mesh.normals[face]), 1.5f, 1e-6f) << face;
        }
        expect_closed(surface);
        displacement.frame = FrameKind::mikk;
        EXPECT_GT(length(make_surface(mesh, &displacement, {}).frame(0).n - mesh.normals[0]), 0.5f);
    }
}

TEST(FileFrames, take_the_tangents_of_the_file_with_their_signs) {
    Mesh mesh = test::make_plane();
    mesh.normals = {{0, 0, 3}};
    mesh.normal_indices = {0, 0, 0, 0};
    mesh.tangents.assign(4, {0, 1, 0, -1});
    const Displacement displacement = make_map(FrameKind::file);
    const Surface turned = make_surface(mesh, &displacement, {});
    const Vec3f middle{0.5f, 0.5f, 0};
    const PatchLevels levels{1, {1, 1, 1, 1}};
    EXPECT_EQ(evaluate_vertex(turned, 0, levels, 1, 1) - middle, (Vec3f{0.5f, 0.25f, 0.125f}));
    mesh.tangents.assign(4, {0, 2, 5, 1}); // not in the plane of the normal, not a unit
    const Surface right = make_surface(mesh, &displacement, {});
    EXPECT_EQ(evaluate_vertex(right, 0, levels, 1, 1) - middle, (Vec3f{-0.5f, 0.25f, 0.125f}));
}

TEST(FileFrames, are_interpolated_where_faces_are_refined) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    test::add_face(mesh, {0, 1, 2}, {{0, 0}, {1, 0}, {0, 1}});
    mesh.normals = {{0, 0.6f, 0.8f}, {0.6f, 0, 0.8f}, {0, 0, 1}};
    mesh.normal_indices = {0, 1, 2};
    mesh.tangents = {{1, 0, 0, 1}, {0.8f, 0, -0.6f, 1}, {1, 0, 0, 1}};
    const Displacement displacement = make_map(FrameKind::file);
    const Surface surface = make_surface(mesh, &displacement, {});
    ASSERT_EQ(surface.patch_count(), 3u);
    const auto& quad = surface.quads[0].vertex; // corner, middle of the first edge, of the face, of the last
    EXPECT_LT(length(surface.frame(quad[0]).n - mesh.normals[0]), 1e-4f);
    EXPECT_LT(length(surface.frame(quad[1]).n - normalize(Vec3f{0.3f, 0.3f, 0.8f})), 1e-4f);
    EXPECT_LT(length(surface.frame(quad[2]).n - normalize(Vec3f{0.2f, 0.2f, 2.6f / 3})), 1e-4f);
    EXPECT_LT(length(surface.frame(quad[3]).n - normalize(Vec3f{0, 0.3f, 0.9f})), 1e-4f);
    const Vec3f n = surface.frame(quad[1]).n, t = normalize(Vec3f{0.9f, 0, -0.3f});
    EXPECT_LT(length(surface.frame(quad[1]).t - normalize(t - n * dot(n, t))), kPacked);
}

TEST(FileFrames, are_refused_where_the_file_has_none_or_they_do_not_last) {
    const auto refuse = [](const Mesh& mesh, const Displacement& displacement) {
        return test::catch_message([&] { make_surface(mesh, &displacement, {}); });
    };
    const auto has = [](const std::string& text, const char* part) {
        return text.find(part) != std::string::npos;
    };
    Displacement displacement = make_map(FrameKind::file);
    EXPECT_TRUE(has(refuse(test::make_plane(), displacement), "mesh has no normals"));
    EXPECT_TRUE(has(refuse(test::make_plane(), displacement), "export it with normals"));
    Mesh cube = make_hard_cube();
    EXPECT_EQ(refuse(cube, displacement), "");
    displacement.lengths = FrameLengths::relative;
    EXPECT_TRUE(has(refuse(cube, displacement), "no lengths for relative"));
    displacement.type = DisplacementType::height;
    EXPECT_EQ(refuse(cube, displacement), "");
    displacement.space = DisplacementSpace::object, displacement.type = DisplacementType::vector;
    EXPECT_EQ(refuse(test::make_plane(), displacement), "") << "object space needs no frames";
    displacement = make_map(FrameKind::file);
    cube.subdivision.scheme = SubdivisionScheme::catmark;
    EXPECT_TRUE(has(refuse(cube, displacement), "subdivided"));
    EXPECT_TRUE(has(refuse(cube, displacement), "scheme none"));
}

/// Two quads of width 1 and 3, each with the whole map, and a sheared one.
Mesh make_unequal_quads() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 2, 0},  {0, 2, 0},  {4, 0, 0},
                      {4, 2, 0}, {9, 0, 0}, {11, 0, 0}, {12, 3, 0}, {10, 3, 0}};
    const std::vector<Vec2f> uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    test::add_face(mesh, {0, 1, 2, 3}, uvs);
    test::add_face(mesh, {1, 4, 5, 2}, uvs);
    test::add_face(mesh, {6, 7, 8, 9}, uvs);
    return mesh;
}

Vec3f measure_move(const Surface& surface, uint32_t patch) {
    Vec3f middle{};
    for (const uint32_t vertex : surface.quads[patch].vertex) middle += surface.position(vertex) * 0.25f;
    return evaluate_vertex(surface, patch, {1, {1, 1, 1, 1}}, 1, 1) - middle;
}

TEST(RelativeLengths, move_in_proportion_to_the_faces_and_along_sheared_axes) {
    for (const FrameKind kind : {FrameKind::dpdu, FrameKind::mikk}) {
        const Displacement relative = make_map(kind, FrameLengths::relative);
        const Surface surface = make_surface(make_unequal_quads(), &relative, {});
        EXPECT_LT(length(measure_move(surface, 0) - Vec3f{0.25f, 1, 0.125f}), 1e-6f);
        EXPECT_LT(length(measure_move(surface, 1) - Vec3f{0.75f, 1, 0.125f}), 1e-6f);
        EXPECT_LT(length(measure_move(surface, 2) - Vec3f{0.5f + 0.5f, 1.5f, 0.125f}), 2e-6f);
        const Displacement absolute = make_map(kind);
        const Surface plain = make_surface(make_unequal_quads(), &absolute, {});
        for (uint32_t patch = 0; patch < 3; ++patch)
            EXPECT_LT(length(measure_move(plain, patch) - Vec3f{0.25f, 0.5f, 0.125f}), 1e-6f);
    }
}

TEST(RelativeLengths, of_mirrored_uvs_and_of_refined_faces_are_those_of_the_whole) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 4, 0}};
    test::add_face(mesh, {0, 1, 2}, {{0, 0}, {-1, 0}, {0, 1}});
    for (const FrameKind kind : {FrameKind::dpdu, FrameKind::mikk}) {
        const Displacement relative = make_map(kind, FrameLengths::relative);
        const Surface surface = make_surface(mesh, &relative, {});
        for (uint32_t patch = 0; patch < 3; ++patch)
            EXPECT_LT(length(measure_move(surface, patch) - Vec3f{-0.5f, 2, 0.125f}), 1e-6f);
    }
}

TEST(RelativeLengths, that_carry_too_far_are_refused) {
    Mesh mesh = test::make_plane();
    for (Vec2f& uv : mesh.uvs) uv = {uv.x * 1e-20f, uv.y};
    const Displacement relative = make_map(FrameKind::dpdu, FrameLengths::relative);
    EXPECT_NE(test::catch_message([&] { make_surface(mesh, &relative, {}); }), "");
    const Displacement absolute = make_map(FrameKind::dpdu);
    EXPECT_EQ(test::catch_message([&] { make_surface(mesh, &absolute, {}); }), "");
}

/// Those of the mesh's faces, whatever the surface is displaced by.
TEST(CornerTangents, of_a_plain_mesh_are_those_of_blender) {
    Surface surface = make_surface(make_reference_mesh(), nullptr, {});
    surface.corner_tangents = make_corner_tangents(surface);
    size_t corner = 0;
    for (uint32_t patch = 0; patch < surface.patch_count(); ++patch) {
        const uint32_t size = surface.quads[patch].is_triangle() ? 3 : 4;
        EXPECT_EQ(find_handedness(surface, patch), test::kMikkCorners[corner].sign) << patch;
        for (size_t k = 0; k < size; ++k, ++corner)
            EXPECT_LT(length(scalar::unpack_tangent(surface.corner_tangents[patch][k]) -
                             to_vector(test::kMikkCorners[corner].tangent)),
                      kPacked)
                << corner;
    }
    EXPECT_EQ(corner, std::size(test::kMikkCorners)) << "no face of the reference is cut";
}

TEST(CornerTangents, of_heights_are_those_that_vectors_move_along) {
    const Mesh mesh = make_unequal_quads();
    Displacement displacement = make_map(FrameKind::mikk);
    const Surface vectors = make_surface(mesh, &displacement, {});
    displacement.type = DisplacementType::height;
    Surface heights = make_surface(mesh, &displacement, {});
    heights.corner_tangents = make_corner_tangents(heights);
    ASSERT_EQ(heights.patch_count(), vectors.patch_count());
    for (uint32_t patch = 0; patch < heights.patch_count(); ++patch)
        for (size_t k = 0; k < 4; ++k) {
            const Frame frame = vectors.frame(vectors.quads[patch].vertex[k]);
            const Vec3f tangent = scalar::unpack_tangent(heights.corner_tangents[patch][k]);
            EXPECT_LT(length(tangent - frame.t), kPacked) << patch << ' ' << k;
            EXPECT_LT(length(cross(frame.n, tangent) * find_handedness(heights, patch) - frame.b), kPacked);
        }
    EXPECT_EQ(make_corner_tangents(vectors)[0][0], vectors.frames[vectors.quads[0].vertex[0]].tangent);
}

} // namespace
TEST(TangentFrames, lengths_do_not_matter_to_heights) {
    Displacement displacement = test::make_displacement(test::make_noise(16, 16, 0.1f, 4));
    displacement.type = DisplacementType::height;
    const Surface absolute = make_surface(test::make_plane(), &displacement, {});
    displacement.lengths = FrameLengths::relative;
    const Surface relative = make_surface(test::make_plane(), &displacement, {});
    EXPECT_TRUE(relative.derivatives.empty());
    EXPECT_EQ(compute_patch_box(relative, 0).upper, compute_patch_box(absolute, 0).upper);
}

} // namespace relief
