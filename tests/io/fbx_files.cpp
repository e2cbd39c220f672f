// FBX: versions and kinds of files.
#include "io/test_files.h"
#include "relief/io.h"
#include "relief/scene.h"
#include "support/fbx_scene.h"

namespace relief {

class FbxFiles : public FileTest {};

TEST_F(FbxFiles, are_read_in_binary_of_either_endianness_and_without_ends_of_leaves) {
    for (const bool is_big_endian : {false, true})
        for (const bool ends_are_left_out : {false, true}) {
            const BinaryFbx file({is_big_endian, ends_are_left_out});
            std::vector<std::string> warnings;
            const Mesh mesh = load_mesh(write("a.fbx", file.bytes()), {}, warnings);
            EXPECT_TRUE(warnings.empty());
            EXPECT_EQ(mesh.positions, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}}));
            EXPECT_EQ(mesh.position_indices, (std::vector<uint32_t>{0, 1, 2}));
        }
}

TEST_F(FbxFiles, of_old_versions_are_refused_with_the_version) {
    const auto expect_refusal = [&](const std::string& bytes, const char* version) {
        const std::string message = message_of([&] { load_mesh(write("a.fbx", bytes)); });
        EXPECT_HAS(message, std::string("is an FBX file of version ") + version);
        EXPECT_HAS(message, "export it as FBX 2020 (7.x), binary");
    };
    expect_refusal(BinaryFbx({.version = 6100}).bytes(), "6.1");
    expect_refusal(BinaryFbx({.version = 5800}).bytes().substr(0, 300), "5.8"); // and not whole
    expect_refusal(FbxScene().replace("FBXVersion: 7400", "FBXVersion: 6100").text(), "6.1");
    expect_refusal("; FBX 6.1.0 project file\nFBXHeaderExtension:  {\n\tFBXVersion: 6100\n}\nTakes:  {\n",
                   "6.1");
    // Lists of old versions begin in the next line, and so do their commas.
    expect_refusal("FBXHeaderExtension:  {\n\tFBXVersion: 6100\n}\nKey: \n\t1,2,L\n\t,3,4,L\n", "6.1");
}

TEST_F(FbxFiles, whose_records_do_not_hold_together_are_warned_of_where_they_are_read) {
    std::string nested;
    for (int k = 0; k < 100; ++k) nested += "A:  {\n";
    for (int k = 0; k < 100; ++k) nested += "}\n";
    std::vector<std::string> warnings;
    load_mesh(write("a.fbx", FbxScene().text() + nested), {}, warnings);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_HAS(warnings[0], "a.fbx: its records cannot be followed to their end");
    for (const size_t size : {30, 100, 300, 500}) {
        const std::string bytes = BinaryFbx({}).bytes();
        EXPECT_HAS(message_of([&] { load_mesh(write("b.fbx", bytes.substr(0, size))); }),
                   "the file is damaged");
    }
}

} // namespace relief
