#include "io/mesh_obj.h"
#include "io/test_files.h"
#include "relief/io.h"

namespace relief {

using MeshFiles = FileTest;

TEST_F(MeshFiles, obj_keeps_quads_ngons_and_separate_indices) {
    const Mesh mesh = parse_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 2 0\nvt 0 0\nvt 1 1\n"
                                "f 1/1 2/2 3/1 4/2\nf -1/1 -2/1 -3/1 -4/1 -5/-1\n",
                                "m.obj");
    EXPECT_EQ(mesh.face_sizes, (std::vector<uint32_t>{4, 5}));
    EXPECT_EQ(mesh.position_indices, (std::vector<uint32_t>{0, 1, 2, 3, 4, 3, 2, 1, 0}));
    EXPECT_EQ(mesh.uv_indices, (std::vector<uint32_t>{0, 1, 0, 1, 0, 0, 0, 0, 1}));
    EXPECT_TRUE(mesh.normal_indices.empty());
}

TEST_F(MeshFiles, obj_keeps_a_face_of_three_hundred_corners) {
    std::string text, face = "f";
    for (int i = 1; i <= 300; ++i)
        text += "v " + std::to_string(i) + " 0 0\n", face += " " + std::to_string(i);
    EXPECT_EQ(parse_obj(text + face + "\n", "m.obj").face_sizes, std::vector<uint32_t>{300});
}

TEST_F(MeshFiles, obj_index_out_of_range_names_file_and_face) {
    const std::string above =
        message_of([] { parse_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nf 1 2 9\n", "m.obj"); });
    EXPECT_HAS(above, "m.obj, face 2");
    EXPECT_HAS(above, "9 is out of range");
    const std::string below = message_of([] { parse_obj("v 0 0 0\nv 1 0 0\nf 1 2 -7\n", "m.obj"); });
    EXPECT_HAS(below, "m.obj, line 3, face 1");
    EXPECT_HAS(message_of([] { parse_obj("v 0 0 0\nf 0 1 1\n", "m.obj"); }), "out of range");
}

TEST_F(MeshFiles, obj_uvs_on_some_faces_only_are_refused) {
    EXPECT_HAS(
        message_of([] { parse_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nf 1/1 2/1 3/1\nf 1 2 3\n", "m.obj"); }),
        "line 6, face 2");
}

TEST_F(MeshFiles, ply_keeps_quads) {
    const auto file =
        write("q.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                       "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                       "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
    const Mesh mesh = load_mesh(file);
    EXPECT_EQ(mesh.face_sizes, std::vector<uint32_t>{4});
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.name, "q");
}

TEST_F(MeshFiles, gltf_positions_are_welded_and_node_transforms_applied) {
    // Two triangles of a square, six corners stored one by one; 6 x 3 floats.
    const float corners[18] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0};
    std::ofstream(folder_ / "s.bin", std::ios::binary)
        .write(reinterpret_cast<const char*>(corners), sizeof corners);
    const auto file = write("s.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
        "nodes":[{"mesh":0,"translation":[0,0,5]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "buffers":[{"uri":"s.bin","byteLength":72}],"bufferViews":[{"buffer":0,"byteLength":72}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":6,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}]})");
    const Mesh mesh = load_mesh(file);
    EXPECT_EQ(mesh.face_sizes, (std::vector<uint32_t>{3, 3}));
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.positions.at(0).z, 5.0f);
}

TEST_F(MeshFiles, missing_unknown_and_broken_files_are_named) {
    write("plane.obj", kQuadObj);
    const std::string missing = message_of([&] { load_mesh(folder_ / "plnae.obj"); });
    EXPECT_HAS(missing, "plnae.obj");
    EXPECT_HAS(missing, "did you mean 'plane.obj'?");
    EXPECT_HAS(message_of([&] { load_mesh(write("a.stl", "x")); }), "unknown kind of mesh '.stl'");
    EXPECT_HAS(message_of([&] { load_mesh(write("a.ply", "ply\nnonsense")); }), "a.ply");
    EXPECT_HAS(message_of([&] { load_mesh(write("e.obj", "v 0 0 0\n")); }), "no faces");
}

} // namespace relief
