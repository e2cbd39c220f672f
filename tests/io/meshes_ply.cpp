#include "io/mesh/mesh_ply.h"

#include "io/test_files.h"
#include "relief/io.h"
#include <algorithm>
#include <bit>
#include <initializer_list>

namespace relief {

namespace {

using PlyFiles = FileTest;

const char* const kVertexLines = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const char* const kFaceLines = "element face 1\nproperty list uchar int vertex_indices\n";
const char* const kSquare = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

std::string make_ascii(const std::string& elements, const std::string& values) {
    return "ply\nformat ascii 1.0\ncomment made by a test\n" + elements + "end_header\n" + values;
}

/// Bytes of values in the byte order of the file.
class Bytes {
  public:
    explicit Bytes(bool is_big_endian) : is_big_endian_(is_big_endian) {}
    template <class T> Bytes& add(std::initializer_list<T> values) {
        for (const T value : values) {
            std::array<char, sizeof(T)> raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
            if (is_big_endian_) std::reverse(raw.begin(), raw.end());
            text_.append(raw.begin(), raw.end());
        }
        return *this;
    }
    const std::string& text() const { return text_; }

  private:
    bool is_big_endian_;
    std::string text_;
};

TEST_F(PlyFiles, quads_and_ngons_are_kept) {
    const auto file = write(
        "q.ply", make_ascii("element vertex 5\nproperty double x\nproperty double y\nproperty double z\n"
                            "element face 2\nproperty list uchar uint vertex_index\n",
                            "0 0 0\n+1 0 0\n1 1 0\n0 1 0\n.5 2e0 -0\n4 0 1 2 3\n5 0 1 2 4 3"));
    const Mesh mesh = load_mesh(file);
    EXPECT_EQ(mesh.face_sizes, (std::vector<uint32_t>{4, 5}));
    EXPECT_EQ(mesh.position_indices, (std::vector<uint32_t>{0, 1, 2, 3, 0, 1, 2, 4, 3}));
    EXPECT_EQ(mesh.positions.size(), 5u);
    EXPECT_EQ(mesh.positions.at(4), (Vec3f{0.5f, 2, 0}));
    EXPECT_EQ(mesh.name, "q");
    EXPECT_TRUE(mesh.uvs.empty());
    EXPECT_TRUE(mesh.normals.empty());
}

TEST_F(PlyFiles, both_byte_orders_any_types_and_any_order_of_elements) {
    for (const bool is_big_endian : {false, true}) {
        Bytes bytes(is_big_endian);
        // The faces come first, with a list that nobody wants in front of the one that is wanted.
        bytes.add<uint16_t>({2}).add<double>({7, 8}).add<int32_t>({4}).add<uint16_t>({0, 1, 2, 3});
        bytes.add<int16_t>({5, 6});
        for (int k = 0; k < 4; ++k) {
            bytes.add<uint8_t>({200}).add<int16_t>({int16_t(k / 2)}).add<int8_t>({int8_t(-k)});
            bytes.add<uint32_t>({uint32_t(k)}).add<float>({0, 0, 1}).add<double>({0.25, 0.5 * k});
        }
        const std::string header =
            std::string("ply\r\nformat binary_") + (is_big_endian ? "big" : "little") +
            "_endian 1.0\r\nelement face 1\r\nproperty list ushort double colours\r\n"
            "property list int32 uint16 vertex_indices\r\nelement edge 2\r\nproperty short a\r\n"
            "element vertex 4\r\nproperty uchar red\r\nproperty short z\r\nproperty int8 y\r\n"
            "property uint x\r\nproperty float32 nx\r\nproperty float ny\r\nproperty float nz\r\n"
            "property float64 s\r\nproperty double t\r\nend_header\r\n";
        const Mesh mesh = parse_ply(header + bytes.text(), "b.ply");
        EXPECT_EQ(mesh.face_sizes, std::vector<uint32_t>{4});
        ASSERT_EQ(mesh.positions.size(), 4u);
        EXPECT_EQ(mesh.positions[3], (Vec3f{3, -3, 1}));
        EXPECT_EQ(mesh.normals, (std::vector<Vec3f>{{0, 0, 1}}));
        EXPECT_EQ(mesh.uvs.at(mesh.uv_indices.at(2)), (Vec2f{0.25f, 1}));
    }
}

TEST_F(PlyFiles, all_names_of_uvs_are_known) {
    for (const auto& [u, v] : {std::pair("s", "t"), {"u", "v"}, {"texture_u", "texture_v"}}) {
        const std::string uvs = std::string("property float ") + u + "\nproperty float " + v + "\n";
        const Mesh mesh = parse_ply(make_ascii(kVertexLines + uvs + kFaceLines,
                                               "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 .5\n0 1 0 0 .5\n4 0 1 2 3\n"),
                                    "u.ply");
        ASSERT_EQ(mesh.uv_indices.size(), 4u) << u;
        EXPECT_EQ(mesh.uvs.at(mesh.uv_indices[2]), (Vec2f{1, 0.5f})) << u;
    }
}

TEST_F(PlyFiles, uvs_of_the_corners_of_faces_win) {
    const std::string elements =
        std::string(kVertexLines) +
        "property float s\nproperty float t\nelement face 2\n"
        "property list uchar float texcoord\nproperty list uchar int vertex_indices\n";
    const std::string points = "0 0 0 9 9\n1 0 0 9 9\n1 1 0 9 9\n0 1 0 9 9\n";
    const Mesh mesh = parse_ply(
        make_ascii(elements, points + "6 0 0 1 0 1 1  3 0 1 2\n6 .5 0 1 1 0 1  3 0 2 3\n"), "w.ply");
    ASSERT_EQ(mesh.uv_indices.size(), 6u);
    EXPECT_EQ(mesh.uvs.size(), 5u); // (1, 1) stands twice
    EXPECT_EQ(mesh.uvs.at(mesh.uv_indices[0]), (Vec2f{0, 0}));
    EXPECT_EQ(mesh.uvs.at(mesh.uv_indices[3]), (Vec2f{0.5f, 0}));
    const Mesh partly =
        parse_ply(make_ascii(elements, points + "0  3 0 2 3\n6 0 0 1 0 1 1  3 0 1 2\n"), "w.ply");
    EXPECT_EQ(partly.uv_indices, (std::vector<uint32_t>{kNoIndex, kNoIndex, kNoIndex, 0, 1, 2}));
}

TEST_F(PlyFiles, equal_positions_are_welded_and_small_faces_left_out) {
    const Mesh mesh =
        parse_ply(make_ascii("element vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
                             "element face 3\nproperty list uchar int vertex_indices\n",
                             "0 0 0\n1 0 0\n1 1 0\n-0 0 0\n1 1 0\n0 1 0\n3 0 1 2\n2 0 1\n3 3 4 5\n"),
                  "w.ply");
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.face_sizes, (std::vector<uint32_t>{3, 3}));
    EXPECT_EQ(mesh.position_indices, (std::vector<uint32_t>{0, 1, 2, 0, 2, 3}));
}

TEST_F(PlyFiles, damaged_headers_name_their_line) {
    const auto complain = [](const std::string& text) {
        return message_of([&] { parse_ply(text, "d.ply"); });
    };
    EXPECT_HAS(complain("plx\n"), "d.ply, line 1: does not begin with the word 'ply'");
    EXPECT_HAS(complain("ply\nformat ascii 1.0\n"), "line 3: the header has no end");
    EXPECT_HAS(complain("ply\nformat ascii 2.0\n"), "line 2: unknown format");
    EXPECT_HAS(complain("ply\nend_header\n"), "no format");
    EXPECT_HAS(complain("ply\nproperty float x\n"), "before the first element");
    EXPECT_HAS(complain("ply\nelement vertex -1\n"), "a name and a count");
    EXPECT_HAS(complain("ply\nelement vertex 1\nelement vertex 1\n"), "'vertex' stands twice");
    EXPECT_HAS(complain("ply\nelement vertex 1\nproperty long x\n"), "line 3: unknown type 'long'");
    EXPECT_HAS(complain("ply\nelement vertex 1\nproperty list x\n"), "unknown type 'list'");
    EXPECT_HAS(complain("ply\nelements 1\n"), "unknown word 'elements'");
}

TEST_F(PlyFiles, damaged_values_name_their_place) {
    const auto complain = [](const std::string& text) {
        return message_of([&] { parse_ply(text, "d.ply"); });
    };
    const std::string header = std::string(kVertexLines) + kFaceLines;
    EXPECT_HAS(complain(make_ascii(kVertexLines, kSquare)), "no faces");
    EXPECT_HAS(complain(make_ascii("element vertex 1\nproperty float x\n" + std::string(kFaceLines), "0\n")),
               "no x, y and z");
    EXPECT_HAS(complain(make_ascii(kVertexLines + std::string("element face 1\nproperty int a\n"), kSquare)),
               "no list 'vertex_indices'");
    EXPECT_HAS(complain(make_ascii(header, "0 0 0\n1 0 0\n1 1\n")), "vertex 2: the file ends early");
    EXPECT_HAS(complain(make_ascii(header, "0 0 0\n1 zero 0\n")),
               "line 12, vertex 1: a number is missing, malformed");
    EXPECT_HAS(complain(make_ascii(header, "0 0 0\n1e999 0 0\n")), "out of range");
    EXPECT_HAS(complain(make_ascii(header, std::string(kSquare) + "4 0 1 2 4\n")),
               "line 15, face 0: vertex index 4 is out of range: there are 4");
    EXPECT_HAS(complain(make_ascii(header, std::string(kSquare) + "4 0 1 2 -1\n")), "-1 is out of range");
    EXPECT_HAS(complain(make_ascii(header, std::string(kSquare) + "4 0 1 2 .5\n")), "0.5 is out of range");
    EXPECT_HAS(complain(make_ascii(header, std::string(kSquare) + "4000000000 0 1 2 3\n")),
               "a list of 4000000000 values does not fit the file");
    const std::string binary = "ply\nformat binary_little_endian 1.0\n" + header + "end_header\n";
    EXPECT_HAS(complain(binary + std::string(47, '\0')), "vertex 3: the file ends early");
    EXPECT_HAS(complain(binary + std::string(48, '\0') + '\x03' + std::string(11, '\0')),
               "face 0: a list of 3 values does not fit the file");
}

} // namespace

TEST_F(PlyFiles, numbers_that_the_header_does_not_declare_are_left_out_where_lines_show_them) {
    const std::string elements = std::string(kVertexLines) + "property uchar red\n" + kFaceLines;
    const Mesh plain =
        load_mesh(write("a.ply", make_ascii(elements, "0 0 0 9\n1 0 0 9\n1 1 0 9\n0 1 0 9\n4 0 1 2 3\n")));
    const auto load = [&](const std::string& text, std::vector<std::string>& warnings) {
        return load_mesh(write("b.ply", text), {}, warnings);
    };
    std::vector<std::string> warnings;
    const Mesh longer = load(
        make_ascii(elements, "0 0 0 9\n1 0 0 9 8 \r\n\n1 1 0 9 8 7\n0 1 0 9\n4 0 1 2 3 0.5 0.25"), warnings);
    EXPECT_EQ(longer.positions, plain.positions);
    EXPECT_EQ(longer.position_indices, plain.position_indices);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_HAS(warnings[0],
               "b.ply: 3 lines hold more numbers than the header declares, the first of them line 13");
    // Read one after the other they would fit, too: 8 vertices in 4 lines.
    warnings.clear();
    const std::string two =
        std::string(kVertexLines) + "element face 4\nproperty list uchar int vertex_indices\n";
    const Mesh misread = load(make_ascii(two, "0 0 0 1 0 0\n1 0 0 0 1 0\n1 1 0 4 0 0\n0 1 0 0 0 0\n"
                                              "3 0 1 2\n3 0 2 3\n3 0 1 3\n3 1 2 3\n"),
                              warnings);
    EXPECT_EQ(misread.face_sizes, (std::vector<uint32_t>{3, 3, 3, 3}));
    EXPECT_EQ(warnings.size(), 1u);
}

TEST_F(PlyFiles, lines_mean_nothing_where_elements_do_not_fit_them) {
    const std::string elements = std::string(kVertexLines) + kFaceLines;
    std::vector<std::string> warnings;
    for (const char* values : {"0 0 0 1 0 0\n1 1 0 0 1 0\n4 0 1 2 3\n", "0 0 0 1 0 0 1 1 0 0 1 0 4 0 1 2 3\n",
                               "0 0\n0\n1 0 0\n1 1 0 0 1\n0 4 0\n1 2 3"}) {
        const Mesh mesh = load_mesh(write("a.ply", make_ascii(elements, values)), {}, warnings);
        EXPECT_EQ(mesh.position_indices, (std::vector<uint32_t>{0, 1, 2, 3})) << values;
    }
    EXPECT_TRUE(warnings.empty());
    // One line more than elements: they are read one after the other, and the face has no corners.
    EXPECT_HAS(message_of([&] {
                   load_mesh(write("b.ply", make_ascii(elements, "0 0 0 9\n1 0 0 9\n1 1 0 9\n0 1 0 9\n"
                                                                 "4 0 1 2 3\n4 0 1 2 3\n")));
               }),
               "the mesh has no faces");
}

TEST_F(PlyFiles, unknown_words_of_a_sound_header_are_warned_of) {
    const std::string elements = std::string("texture a.png\n") + kVertexLines + "author me\n" + kFaceLines;
    std::vector<std::string> warnings;
    const Mesh mesh =
        load_mesh(write("a.ply", make_ascii(elements, std::string(kSquare) + "4 0 1 2 3\n")), {}, warnings);
    EXPECT_EQ(mesh.face_sizes, std::vector<uint32_t>{4});
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_HAS(warnings[0],
               "a.ply: 2 lines of the header begin with unknown words and are not read, the first of "
               "them line 4: 'texture'");
    EXPECT_HAS(message_of([&] {
                   load_mesh(
                       write("b.ply", make_ascii("elemnt face 1\n" + std::string(kVertexLines), kSquare)));
               }),
               "b.ply, line 4: unknown word 'elemnt'");
}

} // namespace relief
