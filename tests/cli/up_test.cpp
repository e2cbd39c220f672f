// --up: which axis of a mesh points up.
#include "command.h"

namespace relief::cli {
namespace {

class Up : public CommandTest {
  protected:
    void SetUp() override {
        CommandTest::SetUp();
        write("tall.obj", "v 0 0 0\nv 1 0 0\nv 1 0 3\nv 0 0 3\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 -1 0\n"
                          "f 1/1/1 2/2/1 3/3/1 4/4/1\n");
    }
};

TEST_F(Up, turns_what_convert_writes_and_inspect_prints) {
    ASSERT_EQ(run({"convert", "tall.obj", "--up", "z", "-o", "up.obj"}).exit_code, 0);
    const std::string text = read("up.obj");
    EXPECT_TRUE(contains(text, "v 1 3 ")) << text;
    EXPECT_TRUE(contains(text, "vn 0 0 1")) << text;
    const CommandResult plain = run({"inspect", "tall.obj", "--up", "z"});
    EXPECT_TRUE(contains(plain.output, " to (1, 3, 0)")) << plain.output;
    const CommandResult of_x = run({"inspect", "tall.obj", "--up", "x"});
    EXPECT_TRUE(contains(of_x.output, " to (0, 1, 3)")) << of_x.output;
    const CommandResult as_it_is = run({"inspect", "tall.obj", "--up", "y"});
    EXPECT_EQ(as_it_is.output, run({"inspect", "tall.obj"}).output);
    // The surface of a map is turned with its mesh.
    ASSERT_EQ(
        run({"convert", "tall.obj", "--up", "z", "--vdm", "bump.exr", "--level", "1", "-o", "bumpy.ply"})
            .exit_code,
        0);
    const CommandResult bumpy = run({"inspect", "bumpy.ply"});
    EXPECT_TRUE(contains(bumpy.output, "to (1, 3,")) << bumpy.output;
}

TEST_F(Up, is_a_rotation_of_the_object_in_a_saved_scene) {
    const CommandResult rendered = run({"render", "tall.obj", "--up", "z", "--size", "16x16", "--spp", "1",
                                        "-o", "a.exr", "--save-scene", "saved.json"});
    ASSERT_EQ(rendered.exit_code, 0) << rendered.errors;
    const std::string scene = read("saved.json");
    EXPECT_TRUE(contains(scene, "\"rotate_degrees\": [-90.0, 0.0, 0.0]") ||
                contains(scene, "\"rotate_degrees\": [-90, 0, 0]"))
        << scene;
    ASSERT_EQ(run({"render", "saved.json", "--size", "16x16", "--spp", "1", "-o", "b.exr"}).exit_code, 0);
    EXPECT_EQ(run({"compare", "a.exr", "b.exr"}).exit_code, 0);
    ASSERT_EQ(
        run({"render", "tall.obj", "--size", "16x16", "--spp", "1", "-o", "c.exr", "--save-scene", "c.json"})
            .exit_code,
        0);
    EXPECT_FALSE(contains(read("c.json"), "\"transform\"")) << read("c.json");
}

TEST_F(Up, goes_with_a_mesh_and_an_axis) {
    EXPECT_EQ(run({"render", "tall.obj", "--up", "w", "-o", "a.exr"}).exit_code, 2);
    EXPECT_EQ(run({"convert", "bump.exr", "--up", "z", "-o", "o.exr"}).exit_code, 2);
    write("scene.json", R"({"meshes": {"p": {"file": "tall.obj"}}, "objects": [{"mesh": "p"}]})");
    EXPECT_EQ(run({"render", "scene.json", "--up", "z", "-o", "a.exr"}).exit_code, 2);
    EXPECT_EQ(run({"convert", "scene.json", "--up", "z", "-o", "a.ply"}).exit_code, 2);
}

} // namespace
} // namespace relief::cli
