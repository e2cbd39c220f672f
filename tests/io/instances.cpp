// Objects in great numbers: a point of a PLY file each, and long lists in the scene file.
#include <cmath>

#include "io/scene/scene_reader.h"
#include "math/affine.h"
#include "relief/io.h"
#include "test_files.h"

namespace relief {

class Instances : public FileTest {
  protected:
    Instances() { write("plane.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n"); }
    /// A plane at each point of points.ply, which is written here.
    Scene load(const std::string& points, const std::string& more = "") {
        write("points.ply", points);
        return parse_scene(
            R"({"materials": {"red": {}, "blue": {}}, "meshes": {"plane": {"file": "plane.obj"}},
            "objects": [{"name": "leaf", "mesh": "plane", "transform": {"translate": [0, 10, 0], "scale": 2},
                         "instances": {"file": "points.ply")" +
                more + "}}]}",
            folder_, "s.json");
    }
};

TEST_F(Instances, points_scale_turn_and_move_in_the_space_of_the_object) {
    // A quarter turn about z: w = z = 1, of any length.
    const Scene scene = load("ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                             "property float z\nproperty float qw\nproperty float qx\nproperty float qy\n"
                             "property float qz\nproperty float scale\nproperty uchar material\nend_header\n"
                             "1 2 3 1 0 0 0 1 1\n0 0 0 5 0 0 5 3 0\n",
                             R"(, "materials": ["red", "blue"])");
    ASSERT_EQ(scene.objects.size(), 2u);
    EXPECT_EQ(scene.objects[0].name, "leaf");
    EXPECT_EQ(scene.objects[0].material, 1u);
    EXPECT_EQ(scene.objects[1].material, 0u);
    EXPECT_EQ(transform_point(scene.objects[0].world_from_object, {1, 0, 0}), (Vec3f{4, 14, 6}));
    const Vec3f turned = transform_point(scene.objects[1].world_from_object, {1, 0, 0});
    EXPECT_NEAR(turned.x, 0, 1e-6f);
    EXPECT_NEAR(turned.y, 16, 1e-5f);
}

TEST_F(Instances, the_points_are_a_part_of_the_hash) {
    const std::string header = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                               "property float z\nend_header\n";
    EXPECT_NE(load(header + "0 0 0\n").hash, load(header + "0 0 1\n").hash);
    EXPECT_EQ(load(header + "0 0 0\n").objects[0].material, kNoIndex);
}

TEST_F(Instances, wrong_points_are_named) {
    const std::string header = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                               "property float z\n";
    const auto complain = [&](const std::string& points, const std::string& more = "") {
        return message_of([&] { load(points, more); });
    };
    const std::string zero = complain(header + "property float scale\nend_header\n0 0 0 1\n0 0 0 0\n");
    EXPECT_NE(zero.find("the scale is 0"), std::string::npos) << zero;
    EXPECT_NE(zero.find("vertex 1"), std::string::npos) << zero;
    EXPECT_NE(complain(header + "property uchar material\nend_header\n0 0 0 0\n0 0 0 1\n")
                  .find("no list of materials"),
              std::string::npos);
    EXPECT_NE(complain(header + "property uchar material\nend_header\n0 0 0 0\n0 0 0 2\n",
                       R"(, "materials": ["red", "blue"])")
                  .find("there are 2"),
              std::string::npos);
    const std::string four =
        "property float qw\nproperty float qx\nproperty float qy\nproperty float qz\nend_header\n";
    EXPECT_NE(complain(header + four + "0 0 0 1 0 0 0\n0 0 0 0 0 0 0\n").find("no length"),
              std::string::npos);
    for (const char* part : {"qw", "qx", "qz"})
        EXPECT_NE(complain(header + "property float " + part + "\nend_header\n0 0 0 1\n0 0 0 1\n")
                      .find("part of a rotation"),
                  std::string::npos)
            << part;
    EXPECT_NE(complain(header + "end_header\n0 0 0\n").find("ends early"), std::string::npos);
    EXPECT_NE(complain("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n")
                  .find("no x, y and z"),
              std::string::npos);
}

/// Reading was quadratic in the number of objects and in that of keys: it would not end before the test is
/// stopped.
TEST_F(Instances, long_lists_are_read_in_linear_time) {
    constexpr int kCount = 200000;
    std::string text = R"({"meshes": {"plane": {"file": "plane.obj"}}, "materials": {)";
    for (int k = 0; k < kCount; ++k) text += (k ? ",\"m" : "\"m") + std::to_string(k) + "\": {}";
    text += R"(}, "objects": [)";
    for (int k = 0; k < kCount; ++k)
        text += std::string(k ? "," : "") + R"({"mesh": "plane", "material": "m)" + std::to_string(k) + "\"}";
    const Scene scene = parse_scene(text + "]}", folder_, "s.json");
    ASSERT_EQ(scene.objects.size(), size_t(kCount));
    EXPECT_EQ(scene.objects[kCount - 1].material, uint32_t(kCount - 1));
    text.insert(text.size() - 1, R"(,"colour":1)");
    EXPECT_NE(
        message_of([&] { parse_scene(text + "]}", folder_, "s.json"); }).find("'colour' in objects[199999]"),
        std::string::npos);
}

} // namespace relief
