// Motion blur and frames that are carried on from one to the next, by the command.
#include <filesystem>
#include <string>
#include <vector>

#include "command.h"
#include "relief/io.h"

namespace relief::cli {
namespace {

class MotionTest : public CommandTest {
  protected:
    void SetUp() override {
        CommandTest::SetUp();
        for (const char* name : {"wave.0001.exr", "wave.0002.exr", "wave.0003.exr"})
            std::filesystem::copy(folder_ / "bump.exr", folder_ / name);
        write_shot("[-0.5, 0.5]");
    }
    void write_shot(const std::string& shutter) {
        write("shot.json", R"({"render": {"width": 24, "height": 16, "spp": 4, "bounces": 1, "frames": "1-3"},
          "camera": {"from": [0, 0, 5], "to": [0, 0, 0], "shutter": )" +
                               shutter + R"(},
          "environment": {"color": [1, 1, 1]},
          "displacements": {"bump": {"file": "wave.####.exr", "type": "vector",
            "scale": {"keys": [[1, [1, 1, 1]], [3, [2, 2, 4]]]}}},
          "meshes": {"plane": {"file": "plane.obj"}},
          "objects": [{"mesh": "plane", "displacement": "bump",
            "transform": {"rotate_degrees": {"keys": [[1, [0, 0, 0]], [3, [0, 40, 90]]]}}}]})");
    }
    CommandResult render_shot(const std::vector<std::string>& more) {
        std::vector<std::string> command = {"render", "shot.json"};
        command.insert(command.end(), more.begin(), more.end());
        return run(command);
    }
    void expect_same(const std::string& a, const std::string& b) {
        const Image first = read_image(folder_ / a), second = read_image(folder_ / b);
        EXPECT_TRUE(first.pixels == second.pixels) << a << " and " << b;
        EXPECT_EQ(first.metadata.at("relief:scene_hash"), second.metadata.at("relief:scene_hash")) << a;
    }
};

TEST_F(MotionTest, frames_of_one_command_are_those_of_several) {
    for (const char* shutter : {"[-0.5, 0.5]", "[0, 0]"}) {
        write_shot(shutter);
        const CommandResult all = render_shot({"-o", "all.####.exr"});
        ASSERT_EQ(all.exit_code, 0) << all.errors;
        for (const std::string frame : {"1", "2", "3"}) {
            ASSERT_EQ(render_shot({"-o", "alone.exr", "--frames", frame}).exit_code, 0);
            expect_same("all.000" + frame + ".exr", "alone.000" + frame + ".exr");
        }
        ASSERT_EQ(render_shot({"-o", "back.exr", "--frames", "3,1"}).exit_code, 0);
        expect_same("back.0001.exr", "all.0001.exr");
        EXPECT_EQ(run({"compare", "all.0001.exr", "all.0002.exr"}).exit_code, 7);
    }
    EXPECT_EQ(render_shot({"-o", "still.exr", "--frames", "2"}).exit_code, 0);
    write_shot("[-0.5, 0.5]");
    EXPECT_EQ(render_shot({"-o", "blur.exr", "--frames", "2"}).exit_code, 0);
    EXPECT_EQ(run({"compare", "still.0002.exr", "blur.0002.exr"}).exit_code, 7);
}

TEST_F(MotionTest, ranges_of_samples_join) {
    ASSERT_EQ(render_shot({"-o", "whole.exr", "--frames", "2", "--layers", "motion"}).exit_code, 0);
    for (const char* range : {"0:3", "3:4"})
        ASSERT_EQ(render_shot({"-o", std::string("part") + range[0] + ".exr", "--frames", "2", "--samples",
                               range, "--layers", "motion"})
                      .exit_code,
                  0);
    ASSERT_EQ(run({"merge", "part0.0002.exr", "part3.0002.exr", "-o", "joined.exr"}).exit_code, 0);
    EXPECT_EQ(run({"compare", "joined.exr", "whole.0002.exr", "--threshold", "1e-5"}).exit_code, 0);
    EXPECT_EQ(
        run({"compare", "joined.exr", "whole.0002.exr", "--layer", "motion", "--threshold", "0"}).exit_code,
        0);
}

TEST_F(MotionTest, goes_on_from_its_checkpoint) {
    ASSERT_EQ(render_shot({"-o", "whole.exr", "--frames", "2"}).exit_code, 0);
    const std::vector<std::string> first = {"-o",    "part.exr", "--frames",     "2",
                                            "--spp", "2",        "--checkpoint", "10"};
    ASSERT_EQ(render_shot(first).exit_code, 0);
    const CommandResult on = render_shot({"--frames", "2", "--resume", "part.0002.exr"});
    ASSERT_EQ(on.exit_code, 0) << on.errors;
    expect_same("part.0002.exr", "whole.0002.exr");
}

TEST_F(MotionTest, keeps_frames_that_are_there_and_renders_those_whose_neighbour_changed) {
    ASSERT_EQ(render_shot({"-o", "s.exr"}).exit_code, 0);
    const std::string kept = render_shot({"-o", "s.exr", "--skip-existing"}).output;
    for (const char* name : {"kept s.0001.exr", "kept s.0002.exr", "kept s.0003.exr"})
        EXPECT_NE(kept.find(name), std::string::npos) << kept;
    std::filesystem::remove(folder_ / "s.0002.exr");
    ASSERT_EQ(run({"convert", "wave.0003.exr", "--to-scale", "0.5", "-o", "other.exr"}).exit_code, 0);
    std::filesystem::rename(folder_ / "other.exr", folder_ / "wave.0003.exr");
    const CommandResult again = render_shot({"-o", "s.exr", "--skip-existing"});
    ASSERT_EQ(again.exit_code, 0) << again.errors;
    EXPECT_NE(again.output.find("kept s.0001.exr"), std::string::npos) << again.output;
    EXPECT_EQ(again.output.find("kept s.0003.exr"), std::string::npos) << again.output;
    ASSERT_EQ(render_shot({"-o", "t.exr", "--frames", "2,3"}).exit_code, 0);
    expect_same("s.0002.exr", "t.0002.exr");
    expect_same("s.0003.exr", "t.0003.exr");
}

/// What a frame becomes does not depend on the one before.
TEST_F(MotionTest, follows_shadow_catchers_and_objects_that_go_far_away) {
    write("shot.json", R"({"render": {"width": 24, "height": 16, "spp": 2, "bounces": 1, "frames": "1-3"},
      "camera": {"from": {"keys": [[2, [0, 0, 5]], [3, [1e5, 0, 5]]], "interpolation": "step"},
        "to": {"keys": [[2, [0, 0, 0]], [3, [1e5, 0, 0]]], "interpolation": "step"}},
      "environment": {"color": [1, 1, 1]},
      "displacements": {"bump": {"file": "wave.####.exr", "type": "vector"}},
      "meshes": {"plane": {"file": "plane.obj"}},
      "objects": [{"mesh": "plane", "displacement": "bump",
          "shadow_catcher": {"keys": [[1, false], [2, true], [3, false]]},
          "transform": {"translate": {"keys": [[2, [0, 0, 0]], [3, [1e5, 0, 0]]], "interpolation": "step"}}},
        {"mesh": "plane", "transform": {"translate": [0, 0, 0.5], "scale": 0.3}}]})");
    const CommandResult all = render_shot({"-o", "all.exr", "--background", "transparent"});
    ASSERT_EQ(all.exit_code, 0) << all.errors;
    for (const std::string frame : {"1", "2", "3"}) {
        ASSERT_EQ(
            render_shot({"-o", "alone.exr", "--background", "transparent", "--frames", frame}).exit_code, 0);
        expect_same("all.000" + frame + ".exr", "alone.000" + frame + ".exr");
    }
    EXPECT_TRUE(read_image(folder_ / "all.0002.exr").find_channel("shadow.C"));
    EXPECT_EQ(render_shot({"-o", "opaque.exr"}).exit_code, 2) << "frame 2 has a catcher before no background";
}

TEST_F(MotionTest, is_refused_where_it_would_be_left_out) {
    for (const std::vector<std::string>& other : {std::vector<std::string>{"--surface", "tessellated"},
                                                  {"--from", "0,0,9"},
                                                  {"--light", "sun:0,45"}}) {
        for (const char* frames : {"2", "1-2"}) {
            std::vector<std::string> command = {"-o", "s.exr", "--frames", frames};
            command.insert(command.end(), other.begin(), other.end());
            const CommandResult result = render_shot(command);
            EXPECT_EQ(result.exit_code, 2) << other[0] << result.errors;
            EXPECT_NE(result.errors.find("camera.shutter"), std::string::npos) << result.errors;
        }
    }
    write_shot("[0.5, -0.5]");
    EXPECT_NE(render_shot({"-o", "s.exr"}).errors.find("shutter"), std::string::npos);
}

} // namespace
} // namespace relief::cli
