#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

#include "io/gltf_document.h"
#include "io/test_files.h"

namespace relief {

namespace {

using GltfFiles = FileTest;
using Document = GltfDocument;

Document make_square() { return make_gltf_square(); }

Mesh parse(const Document& document, const MeshReadOptions& options = {}) {
    return parse_document(document, options);
}

TEST_F(GltfFiles, triangles_strips_and_fans_of_all_kinds_of_indices) {
    Document document = make_square();
    EXPECT_EQ(parse(document).position_indices, (std::vector<uint32_t>{0, 1, 2, 0, 2, 3}));
    primitive_of(document)["indices"] = document.add<uint8_t>("SCALAR", 5121, {0, 1, 2, 3});
    primitive_of(document)["mode"] = 6;
    EXPECT_EQ(parse(document).position_indices, (std::vector<uint32_t>{0, 1, 2, 0, 2, 3}));
    primitive_of(document)["indices"] = document.add<uint32_t>("SCALAR", 5125, {0, 1, 3, 2, 2, 0});
    primitive_of(document)["mode"] = 5;
    const Mesh strip = parse(document); // the last two triangles have no area
    ASSERT_EQ(strip.face_sizes, (std::vector<uint32_t>{3, 3}));
    const std::vector<Vec3f> expected = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    for (size_t k = 0; k < 6; ++k) EXPECT_EQ(strip.positions.at(strip.position_indices[k]), expected[k]) << k;
    primitive_of(document)["mode"] = 1;
    EXPECT_TRUE(parse(document).face_sizes.empty());
}

TEST_F(GltfFiles, encoded_ngons_become_polygons_again) {
    Document document;
    std::vector<float> points;
    for (int k = 0; k < 9; ++k) points.insert(points.end(), {float(k), float(k * k), 0});
    const int positions = document.add_floats("VEC3", points);
    // A pentagon, a quad that begins elsewhere, and two triangles about the same corner that share no edge.
    const int indices = document.add<uint16_t>(
        "SCALAR", 5123, {0, 1, 2, 0, 2, 3, 0, 3, 4, 1, 5, 6, 1, 6, 2, 7, 8, 0, 7, 1, 2});
    document.json["meshes"] = {{{"primitives",
                                 {{{"attributes", {{"POSITION", positions}}},
                                   {"indices", indices},
                                   {"extensions", {{"FB_ngon_encoding", GltfJson::object()}}}}}}}};
    EXPECT_EQ(parse(document).face_sizes, (std::vector<uint32_t>{5, 4, 3, 3}));
    EXPECT_EQ(parse(document).position_indices,
              (std::vector<uint32_t>{0, 1, 2, 3, 4, 1, 5, 6, 2, 7, 8, 0, 7, 1, 2}));
    primitive_of(document).erase("extensions");
    EXPECT_EQ(parse(document).face_sizes.size(), 7u);
}

TEST_F(GltfFiles, positions_are_welded_and_node_transforms_applied) {
    Document document;
    const int positions = document.add_floats("VEC3", {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0});
    document.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", positions}}}}}}}};
    const double half = std::sqrt(0.5);
    document.json["nodes"] = {{{"children", {1}}, {"translation", {0, 0, 5}}},
                              {{"mesh", 0}, {"rotation", {0, 0, half, half}}, {"scale", {2, 1, 1}}},
                              {{"mesh", 0}}}; // of no scene
    document.json["scenes"] = {{{"nodes", {2}}}, {{"nodes", {0}}}};
    document.json["scene"] = 1;
    const Mesh mesh = parse(document);
    EXPECT_EQ(mesh.face_sizes, (std::vector<uint32_t>{3, 3}));
    ASSERT_EQ(mesh.positions.size(), 4u);
    EXPECT_NEAR(mesh.positions[1].x, 0, 1e-6); // scaled, then turned by a quarter about z, then moved
    EXPECT_NEAR(mesh.positions[1].y, 2, 1e-6);
    EXPECT_NEAR(mesh.positions[1].z, 5, 1e-6);
    document.json["nodes"][1] = {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1}}};
    EXPECT_EQ(parse(document).positions[0], (Vec3f{7, 8, 14}));
}

TEST_F(GltfFiles, a_mirroring_node_turns_faces_normals_and_tangents_round) {
    Document document = make_square();
    GltfJson& attributes = primitive_of(document)["attributes"];
    attributes["NORMAL"] = document.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
    attributes["TANGENT"] = document.add_floats("VEC4", {1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, NAN, 0, 0, -1});
    const Mesh plain = parse(document);
    ASSERT_EQ(plain.tangents.size(), 6u);
    EXPECT_EQ(plain.tangents[0], (std::array<float, 4>{1, 0, 0, 1}));
    EXPECT_EQ(plain.tangents[5][3], -1.0f);
    for (const auto& t : plain.tangents) // also those that the file has not
        EXPECT_NEAR(t[0] * t[0] + t[1] * t[1] + t[2] * t[2], 1, 1e-6);
    document.json["nodes"] = {{{"mesh", 0}, {"scale", {-2, 1, 1}}}};
    const Mesh mirrored = parse(document);
    EXPECT_EQ(mirrored.normals, (std::vector<Vec3f>{{0, 0, 1}}));
    const auto at = [&](size_t k) { return mirrored.positions.at(mirrored.position_indices[k]); };
    const Vec3f a = at(0), b = at(1), c = at(2);
    EXPECT_GT((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x), 0); // still seen from above
    EXPECT_EQ(mirrored.tangents[2], (std::array<float, 4>{-1, 0, 0, -1}));
}

/// Text of a file of a triangle below `depth` nodes, each the only child of the one before. `last`: what the
/// last node holds beside the mesh; `scenes`: the scenes of the file.
std::string make_chain(int depth, const std::string& last, const std::string& scenes) {
    std::string nodes;
    for (int k = 0; k + 1 < depth; ++k) nodes += R"({"children":[)" + std::to_string(k + 1) + "]},";
    return R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":36,"uri":"p.bin"}],)"
           R"("bufferViews":[{"buffer":0,"byteLength":36}],)"
           R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)"
           R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)" +
           scenes + R"("nodes":[)" + nodes + R"({"mesh":0)" + last + "}]}";
}

TEST_F(GltfFiles, nodes_may_be_nested_deeply) {
    constexpr int kDepth = 200000;
    const auto parse_text = [](const std::string& text) {
        return parse_gltf(text, "m.gltf", [](const std::string&) { return std::string(36, '\0'); }, {});
    };
    const std::string scenes = R"("scenes":[{"nodes":[0]}],)";
    EXPECT_EQ(parse_text(make_chain(kDepth, R"(,"translation":[1,2,3])", scenes)).positions.at(0),
              (Vec3f{1, 2, 3}));
    EXPECT_EQ(parse_text(make_chain(10, "", "")).face_sizes.size(), 1u);
    EXPECT_HAS(message_of([&] { parse_text(make_chain(10, R"(,"children":[0])", scenes)); }),
               "nodes[0]: is listed twice in the tree of nodes");
    EXPECT_HAS(message_of([&] { parse_text(make_chain(10, R"(,"children":[0])", "")); }),
               "nodes[0]: is a descendant of itself");
}

TEST_F(GltfFiles, nodes_that_are_no_tree_are_refused) {
    Document document = make_square();
    document.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"children", {2}}}, {{"children", {1}}}};
    EXPECT_HAS(message_of([&] { parse(document); }), "nodes[1]: is a descendant of itself");
    document.json["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}};
    EXPECT_HAS(message_of([&] { parse(document); }), "nodes[2]: is listed twice in the tree of nodes");
}

TEST_F(GltfFiles, the_uv_set_is_chosen_and_v_grows_upwards) {
    Document document = make_square();
    GltfJson& attributes = primitive_of(document)["attributes"];
    attributes["TEXCOORD_0"] = document.add_floats("VEC2", {0, 1, 1, 1, 1, 0, 0, 0});
    attributes["TEXCOORD_1"] = document.add<uint16_t>("VEC2", 5123, {0, 0, 65535, 0, 65535, 65535, 0, 65535});
    document.json["accessors"].back()["normalized"] = true;
    const Mesh first = parse(document), second = parse(document, {.uv_set = 1});
    EXPECT_EQ(first.uvs.at(first.uv_indices[0]), (Vec2f{0, 0}));
    EXPECT_EQ(first.uvs.at(first.uv_indices[2]), (Vec2f{1, 1}));
    EXPECT_EQ(second.uvs.at(second.uv_indices[0]), (Vec2f{0, 1}));
    const std::string message = message_of([&] { parse(document, {.uv_set = 2}); });
    EXPECT_HAS(message, "m.glb: has no uv set 2");
    EXPECT_HAS(message, "it has 2, counted from 0");
    GltfJson bare = primitive_of(document);
    bare["attributes"].erase("TEXCOORD_1");
    document.json["meshes"][0]["primitives"].push_back(bare);
    EXPECT_EQ(parse(document).face_sizes.size(), 4u);
    const Mesh partly = parse(document, {.uv_set = 1});
    EXPECT_NE(partly.uv_indices.at(0), kNoIndex);
    EXPECT_EQ(std::count(partly.uv_indices.begin() + 6, partly.uv_indices.end(), kNoIndex), 6);
    validate_mesh(partly);
}

TEST_F(GltfFiles, further_uv_sets_are_read_where_asked_for) {
    Document document = make_square();
    GltfJson& attributes = primitive_of(document)["attributes"];
    attributes["TEXCOORD_0"] = document.add_floats("VEC2", {0, 1, 1, 1, 1, 0, 0, 0});
    attributes["TEXCOORD_1"] = document.add_floats("VEC2", {0, 0, 0.5f, 0, 0.5f, 0.5f, 0, 0.5f});
    EXPECT_TRUE(parse(document).further_uvs.empty());
    Mesh mesh = parse(document, {.further_uv_sets = {0, 1, 2}});
    ASSERT_EQ(mesh.further_uvs.size(), 1u) << "neither the mesh's own nor one that is not there";
    EXPECT_EQ(mesh.uv_set, 0);
    EXPECT_EQ(mesh.further_uvs[0].number, 1);
    const Mesh other = parse(document, {.uv_set = 1, .further_uv_sets = {0}});
    EXPECT_EQ(other.uv_set, 1);
    ASSERT_EQ(other.further_uvs.size(), 1u);
    for (size_t corner = 0; corner < 6; ++corner) {
        EXPECT_EQ(mesh.further_uvs[0].uvs.at(mesh.further_uvs[0].indices.at(corner)),
                  other.uvs.at(other.uv_indices.at(corner)));
        EXPECT_EQ(other.further_uvs[0].uvs.at(other.further_uvs[0].indices.at(corner)),
                  mesh.uvs.at(mesh.uv_indices.at(corner)));
    }
    GltfJson bare = primitive_of(document);
    bare["attributes"].erase("TEXCOORD_1");
    document.json["meshes"][0]["primitives"].push_back(bare);
    document.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"scale", {-1, 1, 1}}}};
    mesh = parse(document, {.further_uv_sets = {1}});
    const std::vector<uint32_t>& indices = mesh.further_uvs.at(0).indices;
    ASSERT_EQ(indices.size(), 24u);
    EXPECT_EQ(std::count(indices.begin() + 6, indices.begin() + 12, kNoIndex), 6);
    EXPECT_EQ(indices[12], indices[2]) << "a mirror walks backwards";
    validate_mesh(mesh);
}

TEST_F(GltfFiles, buffers_may_be_data_or_files_beside) {
    Document document = make_square();
    write("a b.bin", document.buffer);
    document.json["buffers"] = {{{"byteLength", document.buffer.size()}, {"uri", "a%20b.bin"}}};
    EXPECT_EQ(load_mesh(write("s.gltf", document.json.dump())).positions.size(), 4u);
    // The square 0 0 0, 1 0 0, 1 1 0 in base64.
    const std::string data = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAA";
    Document small;
    small.json["bufferViews"] = {{{"buffer", 0}, {"byteLength", 36}}};
    small.json["accessors"] = {{{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}}};
    small.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}};
    const auto load = [&](const std::string& uri) {
        small.json["buffers"] = {{{"byteLength", 36}, {"uri", uri}}};
        return load_mesh(write("d.gltf", small.json.dump()));
    };
    EXPECT_EQ(load("data:application/octet-stream;base64," + data).positions.at(2), (Vec3f{1, 1, 0}));
    EXPECT_HAS(message_of([&] { load("data:text/plain,abc"); }),
               "buffers[0].uri: holds data that is not in base64");
    EXPECT_HAS(message_of([&] { load("data:;base64,AA*A"); }), "where base64 must be");
    EXPECT_HAS(message_of([&] { load("none.bin"); }), "none.bin");
    write("out.bin", document.buffer);
    for (const std::string uri :
         {"../out.bin", "/etc/hostname", "x/%2e%2E/../out.bin", "http://a/b", "a%00b", ""})
        EXPECT_HAS(message_of([&] { load(uri); }), "no file in the folder") << uri;
    EXPECT_EQ(load("x/../a b.bin").face_sizes.size(), 1u);
}

TEST_F(GltfFiles, damaged_documents_name_their_place) {
    const auto complain = [](const auto& change) {
        Document document = make_square();
        change(document);
        return message_of([&] { parse(document); });
    };
    const auto set = [&](const char* pointer, const GltfJson& value) {
        return complain([&](Document& d) { d.json[GltfJson::json_pointer(pointer)] = value; });
    };
    EXPECT_HAS(set("/asset/version", "1.0"), "glTF of version 1.0");
    EXPECT_HAS(set("/accessors/0/count", 5), "accessors[0]: goes to byte 60 of a bufferView of 48 bytes");
    EXPECT_HAS(set("/accessors/0/count", 1e30), "accessors[0].count");
    EXPECT_HAS(set("/accessors/0/count", -1), "accessors[0].count");
    EXPECT_HAS(set("/accessors/0/byteOffset", 4), "accessors[0]: goes to byte 52");
    EXPECT_HAS(set("/accessors/0/bufferView", 9), "there is no bufferView 9: the file has 2");
    EXPECT_HAS(set("/accessors/0/componentType", 5124), "5124");
    EXPECT_HAS(set("/accessors/0/type", "VEC4"), "is of type VEC4, not VEC3");
    EXPECT_HAS(set("/accessors/0/sparse", GltfJson::object()), "accessors[0].sparse: key 'count' is missing");
    EXPECT_HAS(set("/accessors/1/sparse", GltfJson::object()), "accessors[1]: is sparse (export it without");
    EXPECT_HAS(set("/accessors/1/componentType", 5122), "indices must be unsigned integers");
    EXPECT_HAS(set("/bufferViews/0/byteStride", 8), "bufferViews[0].byteStride");
    EXPECT_HAS(set("/bufferViews/0/byteStride", 20), "goes to byte 72");
    EXPECT_HAS(set("/bufferViews/1/byteLength", 1e9), "bufferViews[1]: goes to byte");
    EXPECT_HAS(set("/bufferViews/1/buffer", 1), "there is no buffer 1: the file has 1");
    EXPECT_HAS(set("/meshes/0/primitives/0/attributes", GltfJson::object()), "key 'POSITION' is missing");
    EXPECT_HAS(set("/meshes/0/primitives/0/indices", 0), "is of type VEC3, not SCALAR");
    EXPECT_HAS(set("/nodes", GltfJson::parse(R"([{"children":[1]},{"children":[1]}])")),
               "nodes[1]: is listed twice");
    EXPECT_HAS(set("/nodes", GltfJson::parse(R"([{"mesh":3}])")), "nodes[0].mesh: there is no mesh 3");
    EXPECT_HAS(set("/nodes", GltfJson::parse(R"([{"mesh":0,"rotation":[0,0,0,0]}])")), "has no length");
    EXPECT_HAS(set("/nodes", GltfJson::parse(R"([{"mesh":0,"matrix":[1,2]}])")), "must be 16 numbers, not 2");
    EXPECT_HAS(set("/extensionsRequired", {"EXT_unheard_of"}),
               "extensionsRequired[0]: needs the extension EXT_unheard_of");
    EXPECT_HAS(set("/meshes", {1}), "meshes[0]: must be an object");
    EXPECT_HAS(complain([](Document& d) { d.json["accessors"][0].erase("bufferView"); }),
               "such as that of Draco");
    EXPECT_HAS(complain([](Document& d) {
                   primitive_of(d)["indices"] = d.add<uint16_t>("SCALAR", 5123, {0, 1, 4});
               }),
               "index 2 is 4, out of range: there are 4 vertices");
    EXPECT_HAS(complain([](Document& d) {
                   primitive_of(d)["indices"] = d.add<uint16_t>("SCALAR", 5123, {0, 1, 2, 3});
               }),
               "4 indices do not make triangles");
}

TEST_F(GltfFiles, damaged_containers_are_told) {
    const std::string glb = make_square().make_glb();
    const auto complain = [](const std::string& bytes) {
        return message_of([&] { parse_gltf(bytes, "m.glb", refuse, {}); });
    };
    EXPECT_HAS(complain(glb.substr(0, 15)), "ends in its header");
    EXPECT_HAS(complain(glb.substr(0, glb.size() - 1)), "bytes of the");
    std::string changed = glb;
    changed[4] = 1;
    EXPECT_HAS(complain(changed), "GLB of version 1");
    changed = glb, changed[15] = '\x7f';
    EXPECT_HAS(complain(changed), "the chunk at byte 12 is cut off");
    changed = glb, changed[16] = 'X';
    EXPECT_HAS(complain(changed), "has no JSON");
    EXPECT_HAS(complain("{"), "m.glb, line 1");
    EXPECT_HAS(complain("[1]"), "must be an object");
    const std::string deep(100000, '[');
    EXPECT_HAS(complain(R"({"asset":{"version":"2.0"},"extras":)" + deep), "levels deep");
    EXPECT_HAS(complain(R"({"asset":{"version":"2.0"},"extras":)" + std::string(200, '[')), "broken JSON");
}

} // namespace

} // namespace relief
