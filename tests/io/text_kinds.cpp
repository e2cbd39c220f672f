// Byte order marks, ends of lines and words that nobody reads, in all texts that are read.
#include <bit>

#include <nlohmann/json.hpp>

#include "io/gltf_document.h"
#include "io/mesh/mesh_obj.h"
#include "io/mesh/mesh_ply.h"
#include "io/scene_files.h"
#include "relief/io.h"

namespace relief {

namespace {

constexpr const char* kMark = "\xef\xbb\xbf";

std::string replace_ends(std::string text, const std::string& end) {
    std::string result;
    for (const char c : text) result += c == '\n' ? end : std::string(1, c);
    return result;
}

void expect_square(const Mesh& mesh, const std::string& name) {
    ASSERT_EQ(mesh.position_indices.size(), 4u) << name;
    const std::vector<Vec3f> expected = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    for (size_t k = 0; k < 4; ++k) EXPECT_EQ(mesh.positions[mesh.position_indices[k]], expected[k]) << name;
}

constexpr const char* kPlyHeader = "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 4\n"
                                   "property float x\nproperty float y\nproperty float z\n"
                                   "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

/// A header as it is in front of a body of little-endian bytes.
std::string make_binary_header(const std::string& end) {
    std::string header = kPlyHeader;
    header.replace(header.find("ascii"), 5, "binary_little_endian");
    return replace_ends(header, end);
}

template <class T> void append(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

} // namespace

using TextKinds = SceneFiles;

TEST_F(TextKinds, obj_has_a_mark_and_any_ends_of_lines) {
    for (const std::string start : {"", kMark})
        for (const std::string end : {"\n", "\r", "\r\n"}) {
            std::vector<std::string> warnings;
            const std::string text = start + replace_ends(kQuadObj, end);
            expect_square(parse_obj(text, "m.obj", &warnings), text);
            EXPECT_TRUE(warnings.empty()) << warnings.front();
        }
    EXPECT_HAS(message_of([] { parse_obj(std::string("\xff\xfev\0 \0", 6), "m.obj"); }), "UTF-16");
}

TEST_F(TextKinds, words_that_obj_does_not_have_are_counted) {
    std::vector<std::string> warnings;
    const std::string text = std::string("o square\ng a b\ns off\nl 1 2\n# a word\n\n") + kQuadObj +
                             "colour 1 2 3\nV 0 0 0\nmtllib x.mtl\nvp 1\ncurv2 1 2\n";
    expect_square(parse_obj(text, "m.obj", &warnings), text);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_HAS(warnings[0], "m.obj: 2 lines begin with words that OBJ does not have");
    EXPECT_HAS(warnings[0], "the first is 'colour' in line 17");
    warnings.clear();
    parse_obj(std::string(kQuadObj) + "cstype bezier\nsurf 0 1 0 1 1 2 3 4\n", "m.obj", &warnings);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_HAS(warnings[0], "curved surfaces");
    std::vector<std::string> of_file;
    load_mesh(write("w.obj", std::string(kQuadObj) + "what 1\n"), {}, of_file);
    ASSERT_EQ(of_file.size(), 1u) << "the reader of files passes them on";
    EXPECT_HAS(load_mesh_scene(folder_ / "w.obj", {}).warnings.at(0), "'what' in line 11");
}

TEST_F(TextKinds, ply_has_a_mark_and_any_ends_of_lines) {
    const std::string body = "-1 -1 0\n1 -1 0\n1 1 0\n-1 1 0\n4 0 1 2 3\n";
    for (const std::string start : {"", kMark})
        for (const std::string end : {"\n", "\r", "\r\n"}) {
            const std::string text = start + replace_ends(kPlyHeader + body, end);
            expect_square(parse_ply(text, "m.ply"), text);
            const std::string damaged = start + replace_ends(kPlyHeader + body + "x", end);
            EXPECT_HAS(message_of([&] {
                           parse_ply(replace_ends(kPlyHeader + std::string("-1 -1 0\nx\n"), end), "m.ply");
                       }),
                       "line 12");
        }
    EXPECT_HAS(message_of([] { parse_ply(std::string("\xfe\xff\0p", 4), "m.ply"); }), "UTF-16");
}

/// The first float of each body begins with the byte of LF.
TEST_F(TextKinds, a_binary_body_begins_behind_the_end_of_the_header) {
    std::string body;
    const float first = std::bit_cast<float>(0x3f80000au),
                values[] = {first, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
    for (const float value : values) append(body, value);
    append(body, uint8_t(4));
    for (const int32_t index : {0, 1, 2, 3}) append(body, index);
    ASSERT_EQ(body.front(), '\n');
    for (const std::string end : {"\n", "\r", "\r\n"}) {
        const Mesh mesh = parse_ply(make_binary_header(end) + body, "m.ply");
        ASSERT_EQ(mesh.position_indices.size(), 4u);
        EXPECT_EQ(mesh.positions[mesh.position_indices[0]], (Vec3f{first, -1, 0})) << int(end[0]);
        EXPECT_EQ(mesh.positions[mesh.position_indices[3]], (Vec3f{-1, 1, 0}));
    }
}

TEST_F(TextKinds, scenes_and_gltf_have_a_mark_and_any_ends_of_lines) {
    const std::string scene = "{ // a scene\n\"meshes\": {\"plane\": {\"file\": \"plane.obj\"}},\n"
                              "\"objects\": [{\"mesh\": \"plane\"}]\n}";
    for (const std::string end : {"\n", "\r", "\r\n"}) {
        EXPECT_EQ(parse(kMark + replace_ends(scene, end)).objects.size(), 1u);
        EXPECT_HAS(error_of(replace_ends("{\n\"meshes\": {},\n\"objects\" []\n}", end)), "s.json, line 3");
    }
    EXPECT_HAS(error_of(std::string("\xff\xfe{\0", 4)), "UTF-16");
    const GltfJson document = {{"asset", {{"version", "2.0"}}}, {"meshes", GltfJson::array()}};
    EXPECT_TRUE(parse_gltf(kMark + document.dump(), "m.gltf", refuse, {}).face_sizes.empty());
}

TEST_F(TextKinds, nesting_is_limited_in_scenes_and_gltf) {
    for (const size_t depth : {size_t(300), size_t(30000), size_t(1000000)}) {
        std::string objects, arrays(depth, '[');
        for (size_t k = 0; k < depth; ++k) objects += "{\"a\":";
        for (const std::string& deep : {objects, arrays, arrays + std::string(depth, ']')}) {
            const std::string text = "{\n\"objects\": " + deep;
            EXPECT_HAS(error_of(text), "nested more than 256 levels deep");
            EXPECT_HAS(error_of(text), "s.json, line 2");
            EXPECT_HAS(message_of([&] { parse_gltf(text, "m.gltf", refuse, {}); }), "levels deep");
        }
    }
    std::string extras = "1";
    for (int k = 0; k < 200; ++k) extras = "[" + extras + "]";
    const std::string text = R"({"asset": {"version": "2.0"}, "extras": )" + extras + "}";
    EXPECT_TRUE(parse_gltf(text, "m.gltf", refuse, {}).face_sizes.empty());
}

TEST_F(TextKinds, paths_of_windows_are_tried_with_slashes) {
    std::filesystem::create_directories(folder_ / "sp ace" / "meshes");
    std::filesystem::copy(folder_ / "plane.obj", folder_ / "sp ace" / "meshes" / "plane.obj");
    std::filesystem::copy(folder_ / "map.exr", folder_ / "sp ace" / "map.1001.exr");
    const auto make = [](const std::string& mesh, const std::string& map) {
        return R"({"displacements": {"d": {"file": ")" + map + R"("}}, "meshes": {"m": {"file": ")" + mesh +
               R"("}}, "objects": [{"mesh": "m", "displacement": "d"}]})";
    };
    const Scene scene = parse(make(R"(sp ace\\meshes\\plane.obj)", R"(.\\sp ace\\map.<UDIM>.exr)"));
    EXPECT_EQ(scene.meshes.at(0).face_sizes.size(), 1u);
    EXPECT_EQ(scene.displacements.at(0).tiles.size(), 1u);
    const std::string strange = R"(a\plane.obj)"; // a name like any other here
    std::filesystem::copy(folder_ / "plane.obj", folder_ / strange);
    EXPECT_EQ(parse(make(R"(a\\plane.obj)", "map.exr")).meshes.at(0).source, (folder_ / strange).string());
    EXPECT_HAS(error_of(make(R"(sp ace\\meshes\\plan.obj)", "map.exr")), "did you mean 'plane.obj'");
    EXPECT_HAS(error_of(make(R"(C:\\meshes\\plane.obj)", "map.exr")), "drive of Windows");
}

} // namespace relief
