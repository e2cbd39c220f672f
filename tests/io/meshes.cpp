#include <assimp/Exporter.hpp>
#include <assimp/scene.h>

#include "io/mesh/mesh_obj.h"
#include "io/mesh/mesh_ply.h"
#include "io/mesh/mesh_writer.h"
#include "io/scene/scene_reader.h"
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

TEST_F(MeshFiles, obj_numbers_that_are_none_are_named_with_their_line) {
    const auto error_of = [&](const std::string& line) {
        write("n.obj", "# made by hand\r\nv 0 0 0\r\n" + line + "\nv 1 1 0\nf 1 2 3\n");
        return message_of([&] { load_mesh(folder_ / "n.obj"); }, ErrorKind::bad_input);
    };
    EXPECT_HAS(error_of("v nan 1 0"), "n.obj, line 3: 'nan' is not a number");
    EXPECT_NO_THROW(parse_obj("v 0 0 0 nan nan nan\nv 1 0 0\nv 1 1 0\nf 1 2 3\n", "c.obj")) << "a colour";
    EXPECT_HAS(error_of("v 1 inf 0"), "'inf' is not a number");
    EXPECT_HAS(error_of("v 1,5 2,5 0,25"), "line 3: '1,5' is not a number");
    EXPECT_HAS(error_of("v 1 0"), "line 3: 'v' has 2 of 3 numbers");
    EXPECT_HAS(error_of("vt abc 0"), "'abc' is not a number");
    EXPECT_HAS(error_of("vn 0 0"), "'vn' has 2 of 3 numbers");
    EXPECT_HAS(error_of("  v\t1 0 0x"), "'0x' is not a number");
    for (const char* line :
         {"v 1 0 0", "v +1 -.5e-3 1. 1 # a corner", " v\t1 0 0 0.5 0.25 1", "v 1 0 1e-60"}) {
        write("n.obj", std::string("v 0 0 0\r") + line + "\rvt 0.5\rv 1 1 0\rf 1 2 3\r");
        EXPECT_EQ(load_mesh(folder_ / "n.obj").positions.size(), 3u) << line;
    }
}

TEST_F(MeshFiles, obj_lines_go_on_after_a_backslash) {
    const std::string points =
        "# C:\\\nv 0 0\\\r\n 0\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0\nvt 0.5\nvt 0 1\nvt 1 1 0\n";
    const Mesh mesh = parse_obj(points + "f -3/1 \\\n-2/-2 # 9\\\n", "m.obj");
    EXPECT_EQ(mesh.positions.size(), 3u);
    EXPECT_TRUE(mesh.face_sizes.empty());
    EXPECT_EQ(parse_obj(points + "f -3/1 -2/-2 \\\n\\\n -1/3", "m.obj").uv_indices,
              (std::vector<uint32_t>{0, 1, 2}));
    EXPECT_HAS(message_of([&] { parse_obj(points + "f 1 2 \\\n 3\nv x\n", "m.obj"); }),
               "m.obj, line 11: 'x'");
    EXPECT_HAS(message_of([&] { parse_obj(points + "f 1 2 3,\n", "m.obj"); }),
               "m.obj, line 9, face 1: index '3,'");
    EXPECT_HAS(message_of([&] { parse_obj(points + "f 1 2 1/1/1/1\n", "m.obj"); }),
               "more than three indices");
}

TEST_F(MeshFiles, faces_without_uvs_stand_among_others_and_are_written_so) {
    const char* const text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nvn 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\n"
                             "f 1//1 2//1 3//1\nf 1/1/1 2/2/1 3/3/1\nf 1/1/1 2//1 3/3/1\n";
    const Mesh mesh = parse_obj(text, "m.obj");
    constexpr uint32_t kNone = kNoIndex;
    EXPECT_EQ(mesh.uv_indices, (std::vector<uint32_t>{kNone, kNone, kNone, 0, 1, 2, kNone, kNone, kNone}));
    validate_mesh(mesh);
    const Mesh obj = parse_obj(format_obj(mesh), "again.obj");
    EXPECT_EQ(obj.uv_indices, mesh.uv_indices);
    EXPECT_EQ(obj.normal_indices, mesh.normal_indices);
    EXPECT_EQ(parse_ply(format_ply(mesh), "again.ply").uv_indices, mesh.uv_indices);
    EXPECT_TRUE(parse_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nf 1 2 3\n", "m.obj").uv_indices.empty());
}

TEST_F(MeshFiles, obj_tags_become_creases) {
    const std::string points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
    const Mesh mesh = parse_obj(points + "t crease 2/1/0 0 1 2.5\n\tt crease 4/2/0  1 2 2 3  1 -3 \r\n"
                                         "t corner 2/1/0 3 0 10\nt interpolateboundary 1/0/0 2\n",
                                "m.obj");
    ASSERT_EQ(mesh.creases.size(), 5u);
    const auto expect = [&](size_t k, uint32_t first, uint32_t second, float sharpness) {
        EXPECT_EQ(mesh.creases[k].first, first) << k;
        EXPECT_EQ(mesh.creases[k].second, second) << k;
        EXPECT_EQ(mesh.creases[k].sharpness, sharpness) << k;
    };
    expect(0, 0, 1, 2.5f);
    expect(1, 1, 2, 1.0f);
    expect(2, 2, 3, 0.0f); // below 0 means smooth
    expect(3, 3, 3, 10.0f);
    expect(4, 0, 0, 10.0f);
    EXPECT_TRUE(parse_obj(points, "m.obj").creases.empty());
}

TEST_F(MeshFiles, damaged_obj_tags_name_their_line) {
    const auto complain = [](const std::string& tag) {
        return message_of([&] { parse_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n" + tag, "m.obj"); });
    };
    EXPECT_HAS(complain("t crease 2/1/0 0 3 1\n"), "m.obj, line 5: position 3 is out of range: there are 3");
    EXPECT_HAS(complain("t crease 2/1/0 0 -1 1\n"), "'-1' stands where a number must be");
    EXPECT_HAS(complain("t crease 2/1/0 0 1\n"), "'' stands where a number must be");
    EXPECT_HAS(complain("t crease 2/1/0 1 1 1\n"), "two positions");
    EXPECT_HAS(complain("t crease 3/1/0 0 1 2 1\n"), "3 positions with 1 sharpnesses");
    EXPECT_HAS(complain("t crease 4/3/0 0 1 1 2 1 1 1\n"), "4 positions with 3 sharpnesses");
    EXPECT_HAS(complain("t crease 99999999999/1/0 0 1 1\n"), "more than its line holds");
    EXPECT_HAS(complain("t corner 1\n"), "counts");
    EXPECT_HAS(complain("t corner 1/1/0 0 nan\n"), "must be finite");
}

TEST_F(MeshFiles, files_with_one_uv_set_refuse_another) {
    const auto obj = write("plane.obj", kQuadObj);
    EXPECT_EQ(load_mesh(obj, {.uv_set = 0}).uvs.size(), 4u);
    const std::string message = message_of([&] { load_mesh(obj, {.uv_set = 1}); });
    EXPECT_HAS(message, "plane.obj: has no uv set 1");
    EXPECT_HAS(message, "one set, number 0");
    EXPECT_HAS(message_of([&] { load_mesh(write("a.ply", "ply\n"), {.uv_set = 2}); }), "has no uv set 2");
}

TEST_F(MeshFiles, a_scene_file_chooses_the_uv_set) {
    write("plane.obj", kQuadObj);
    const auto parse = [&](const std::string& uv_set) {
        return parse_scene(R"({"meshes": {"p": {"file": "plane.obj", "uv_set": )" + uv_set + "}}}", folder_);
    };
    EXPECT_EQ(parse("0").meshes.at(0).uvs.size(), 4u);
    EXPECT_HAS(message_of([&] { parse("1"); }), "meshes.p.file: ");
    EXPECT_HAS(message_of([&] { parse("1"); }), "plane.obj: has no uv set 1");
    EXPECT_HAS(message_of([&] { parse("-1"); }), "meshes.p.uv_set: must be in [0, 255], not -1");
    EXPECT_HAS(message_of([&] { parse("\"a\""); }), "meshes.p.uv_set: must be an integer");
}

TEST_F(MeshFiles, a_saved_scene_keeps_creases) {
    write("plane.obj", kQuadObj + std::string("t crease 2/1/0 0 1 0.1\nt corner 1/1/0 2 12\n"));
    const Scene scene = parse_scene(R"({"meshes": {"p": {"file": "plane.obj"}}})", folder_);
    save_scene(scene, folder_ / "out");
    const Scene again = load_scene(folder_ / "out/scene.json");
    ASSERT_EQ(again.meshes.at(0).creases.size(), 2u);
    for (size_t k = 0; k < 2; ++k) {
        const Crease &a = scene.meshes[0].creases[k], &b = again.meshes[0].creases[k];
        EXPECT_TRUE(a.first == b.first && a.second == b.second && a.sharpness == b.sharpness) << k;
    }
    write("plane.obj", kQuadObj);
    EXPECT_NE(parse_scene(R"({"meshes": {"p": {"file": "plane.obj"}}})", folder_).hash, scene.hash);
}

/// Writes a square with normals and two sets of uvs, the second of half the size, through Assimp.
void write_fbx(const std::filesystem::path& file) {
    aiScene scene;
    scene.mRootNode = new aiNode("root");
    scene.mRootNode->mMeshes = new unsigned[1]{0};
    scene.mRootNode->mNumMeshes = 1;
    scene.mMaterials = new aiMaterial* [1] { new aiMaterial };
    scene.mNumMaterials = 1;
    auto* mesh = new aiMesh;
    scene.mMeshes = new aiMesh* [1] { mesh };
    scene.mNumMeshes = 1;
    mesh->mPrimitiveTypes = aiPrimitiveType_POLYGON;
    mesh->mNumVertices = 4;
    mesh->mVertices = new aiVector3D[4]{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh->mNormals = new aiVector3D[4]{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    for (unsigned set = 0; set < 2; ++set) {
        mesh->mTextureCoords[set] = new aiVector3D[4];
        mesh->mNumUVComponents[set] = 2;
        for (unsigned k = 0; k < 4; ++k)
            mesh->mTextureCoords[set][k] = mesh->mVertices[k] * (set == 0 ? 1.0f : 0.5f);
    }
    mesh->mNumFaces = 1;
    mesh->mFaces = new aiFace[1];
    mesh->mFaces[0].mNumIndices = 4;
    mesh->mFaces[0].mIndices = new unsigned[4]{0, 1, 2, 3};
    Assimp::Exporter exporter;
    ASSERT_EQ(exporter.Export(&scene, "fbxa", file.string()), aiReturn_SUCCESS) << exporter.GetErrorString();
}

TEST_F(MeshFiles, fbx_keeps_quads_and_has_several_uv_sets) {
    write_fbx(folder_ / "a.fbx");
    for (const int set : {0, 1}) {
        const Mesh mesh = load_mesh(folder_ / "a.fbx", {.uv_set = set});
        EXPECT_EQ(mesh.face_sizes, std::vector<uint32_t>{4});
        EXPECT_EQ(mesh.positions.size(), 4u);
        EXPECT_EQ(mesh.normal_indices.size(), 4u);
        ASSERT_EQ(mesh.uv_indices.size(), 4u);
        EXPECT_EQ(mesh.uvs.at(mesh.uv_indices[2]), (set == 0 ? Vec2f{1, 1} : Vec2f{0.5f, 0.5f}));
    }
    EXPECT_HAS(message_of([&] { load_mesh(folder_ / "a.fbx", {.uv_set = 2}); }), "a.fbx: has no uv set 2");
    EXPECT_HAS(message_of([&] { load_mesh(folder_ / "a.fbx", {.uv_set = 200}); }), "has no uv set 200");
}

TEST_F(MeshFiles, further_uv_sets_of_fbx_are_read_where_asked_for_in_a_child_too) {
    write_fbx(folder_ / "a.fbx");
    EXPECT_TRUE(load_mesh(folder_ / "a.fbx").further_uvs.empty());
    for (const char* program : {"", RELIEF_BINARY}) {
        MeshReadOptions options{.uv_set = 1, .further_uv_sets = {0, 1, 7}};
        options.reader.program = program;
        const Mesh mesh = load_mesh(folder_ / "a.fbx", options);
        EXPECT_EQ(mesh.uv_set, 1);
        EXPECT_EQ(mesh.uvs.at(mesh.uv_indices.at(2)), (Vec2f{0.5f, 0.5f}));
        ASSERT_EQ(mesh.further_uvs.size(), 1u) << "of those that are there, each once";
        EXPECT_EQ(mesh.further_uvs[0].number, 0);
        ASSERT_EQ(mesh.further_uvs[0].indices.size(), 4u);
        EXPECT_EQ(mesh.further_uvs[0].uvs.at(mesh.further_uvs[0].indices[2]), (Vec2f{1, 1}));
        validate_mesh(mesh);
    }
}

TEST_F(MeshFiles, missing_unknown_and_broken_files_are_named) {
    write("plane.obj", kQuadObj);
    const std::string missing = message_of([&] { load_mesh(folder_ / "plnae.obj"); });
    EXPECT_HAS(missing, "plnae.obj");
    EXPECT_HAS(missing, "did you mean 'plane.obj'?");
    EXPECT_HAS(message_of([&] { load_mesh(write("a.xyz", "x")); }), "unknown kind of mesh '.xyz'");
    EXPECT_HAS(message_of([&] { load_mesh(write("a.ply", "ply\nnonsense")); }), "a.ply");
    EXPECT_HAS(message_of([&] { load_mesh(write("e.obj", "v 0 0 0\n")); }), "no faces");
}

} // namespace relief
