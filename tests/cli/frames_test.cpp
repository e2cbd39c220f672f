// Frames of a shot by one command.
#include <filesystem>

#include "command.h"
#include "relief/io.h"

namespace relief::cli {
namespace {

class FramesTest : public CommandTest {
  protected:
    void SetUp() override {
        CommandTest::SetUp();
        write("shot.json", R"({"render": {"width": 24, "height": 16, "spp": 2, "bounces": 1, "frames": "1-3"},
          "camera": {"from": {"keys": [[1, [0, 0, 5]], [3, [2, 1, 4]]]}, "to": [0, 0, 0]},
          "environment": {"color": [1, 1, 1]},
          "materials": {"clay": {"base_color": {"keys": [[3, [0.8, 0.8, 0.8]], [4, [0.1, 0.8, 0.1]]]}}},
          "displacements": {"bump": {"file": "bump.exr", "type": "vector"}},
          "meshes": {"plane": {"file": "plane.obj"}},
          "objects": [{"mesh": "plane", "displacement": "bump", "material": "clay"}]})");
    }
    /// Of pixels and of the scene that they name.
    void expect_same(const std::string& a, const std::string& b) {
        const Image first = read_image(folder_ / a), second = read_image(folder_ / b);
        EXPECT_TRUE(first.pixels == second.pixels) << a << " and " << b;
        EXPECT_EQ(first.metadata.at("relief:scene_hash"), second.metadata.at("relief:scene_hash")) << a;
    }
};

TEST_F(FramesTest, are_those_of_the_file_or_the_command_and_the_same_alone) {
    const CommandResult all = run({"render", "shot.json", "-o", "all.####.exr", "--frames", "1-4"});
    ASSERT_EQ(all.exit_code, 0) << all.errors;
    for (const char* frame : {"1", "2", "3", "4"}) {
        const std::string name = std::string("alone.000") + frame + ".exr";
        ASSERT_EQ(run({"render", "shot.json", "-o", "alone.exr", "--frames", frame}).exit_code, 0);
        expect_same(std::string("all.000") + frame + ".exr", name);
    }
    EXPECT_EQ(run({"compare", "all.0001.exr", "all.0002.exr"}).exit_code, 7);
    EXPECT_EQ(run({"compare", "all.0003.exr", "all.0004.exr"}).exit_code, 7);
    ASSERT_EQ(run({"render", "shot.json", "-o", "file.exr"}).exit_code, 0);
    EXPECT_TRUE(exists("file.0001.exr") && exists("file.0003.exr") && !exists("file.0004.exr"));
    expect_same("file.0002.exr", "all.0002.exr");
}

TEST_F(FramesTest, are_named_by_their_progress) {
    const std::string errors =
        run({"render", "shot.json", "-o", "p.exr", "--frames", "4,2", "--progress", "json"}).errors;
    const size_t first = errors.find("\"frame 4, 1 of 2\""), second = errors.find("\"frame 2, 2 of 2\"");
    EXPECT_TRUE(first < second && second < errors.size()) << errors;
    const std::string turns =
        run({"render", "plane.obj", "-o", "t.png", "--size", "8x8", "--turntable", "2", "--progress", "json"})
            .errors;
    EXPECT_NE(turns.find("\"picture 2 of 2\""), std::string::npos) << turns;
}

TEST_F(FramesTest, of_tessellated_surfaces_too) {
    const std::vector<std::string> command = {"render", "shot.json", "--surface", "tessellated"};
    const auto with = [&](const std::vector<std::string>& more) {
        std::vector<std::string> all = command;
        all.insert(all.end(), more.begin(), more.end());
        return run(all).exit_code;
    };
    ASSERT_EQ(with({"--frames", "1,2", "-o", "t.exr"}), 0);
    ASSERT_EQ(with({"--frames", "2", "-o", "u.exr"}), 0);
    expect_same("t.0002.exr", "u.0002.exr");
}

TEST_F(FramesTest, that_are_there_whole_are_kept) {
    ASSERT_EQ(run({"render", "shot.json", "-o", "s.exr"}).exit_code, 0);
    const auto stamp = [&](const char* name) { return std::filesystem::last_write_time(folder_ / name); };
    const auto first = stamp("s.0001.exr");
    std::filesystem::remove(folder_ / "s.0002.exr");
    write("s.0003.exr", read("s.0003.exr").substr(0, 200));
    const auto torn = stamp("s.0003.exr");
    const CommandResult again = run({"render", "shot.json", "-o", "s.exr", "--skip-existing"});
    ASSERT_EQ(again.exit_code, 0) << again.errors;
    EXPECT_NE(again.output.find("kept s.0001.exr"), std::string::npos) << again.output;
    EXPECT_EQ(stamp("s.0001.exr"), first);
    EXPECT_TRUE(exists("s.0002.exr"));
    EXPECT_NE(stamp("s.0003.exr"), torn);
    EXPECT_EQ(read_image(folder_ / "s.0003.exr").width, 24);
    // Of other samples, another size or scene it is another picture.
    for (const std::vector<std::string>& other : {std::vector<std::string>{"--spp", "3"},
                                                  {"--size", "12x8"},
                                                  {"--bounces", "0"},
                                                  {"--seed", "4"},
                                                  {"--layers", "depth"},
                                                  {"--noise", "0.3"},
                                                  {"--background", "transparent"},
                                                  {"--background", "black"},
                                                  {"--crop", "0,0,24,8"},
                                                  {"--tile", "0/2"},
                                                  {"--tile", "1/2"}}) {
        std::vector<std::string> command = {"render", "shot.json", "-o", "s.exr", "--skip-existing"};
        command.insert(command.end(), other.begin(), other.end());
        const auto before = stamp("s.0001.exr");
        ASSERT_EQ(run(command).exit_code, 0);
        EXPECT_NE(stamp("s.0001.exr"), before) << other[0];
    }
}

TEST_F(FramesTest, take_the_place_of_no_file_of_another_frame) {
    std::filesystem::copy(folder_ / "bump.exr", folder_ / "env.0002.exr");
    std::filesystem::copy(folder_ / "bump.exr", folder_ / "map.0002.exr");
    const std::string before = read("env.0002.exr");
    write("shot.json", R"({"render": {"width": 8, "height": 8, "spp": 1},
      "camera": {"from": {"keys": [[1, [0, 0, 5]], [3, [2, 1, 4]]]}}, "environment": {"file": "env.0002.exr"},
      "meshes": {"plane": {"file": "plane.obj"}}, "objects": [{"mesh": "plane"}]})");
    const CommandResult result = run({"render", "shot.json", "-o", "env.####.exr", "--frames", "1-3"});
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_EQ(read("env.0002.exr"), before);
    EXPECT_FALSE(exists("env.0001.exr")) << "before the first frame";
}

TEST_F(FramesTest, that_lack_a_file_are_told_before_the_first) {
    std::filesystem::copy(folder_ / "bump.exr", folder_ / "wave.0001.exr");
    write("shot.json", R"({"render": {"width": 8, "height": 8, "spp": 1, "frames": "1-2"},
      "displacements": {"bump": {"file": "wave.####.exr", "type": "vector"}}, "environment": {"color": [1, 1, 1]},
      "meshes": {"plane": {"file": "plane.obj"}}, "objects": [{"mesh": "plane", "displacement": "bump"}]})");
    const CommandResult result = run({"render", "shot.json", "-o", "s.exr"});
    EXPECT_EQ(result.exit_code, 3) << result.errors;
    EXPECT_NE(result.errors.find("wave.0002.exr"), std::string::npos) << result.errors;
    EXPECT_NE(result.errors.find("frame 2"), std::string::npos) << result.errors;
    EXPECT_FALSE(exists("s.0001.exr"));
}

TEST_F(FramesTest, tell_each_warning_once_and_in_the_words_of_the_scene_file) {
    write("tilted.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 2 0\nvt 2 2\nvt 0 2\n"
                        "f 1/1 2/2 3/3 4/4\n"); // uvs outside of the image
    write("shot.json", R"({"render": {"width": 8, "height": 8, "spp": 1, "frames": "1-3"},
      "camera": {"from": {"keys": [[1, [0, 0, 5]], [3, [2, 1, 4]]]}}, "environment": {"color": [1, 1, 1]},
      "displacements": {"bump": {"file": "bump.exr", "scale": {"keys": [[1, 0.1], [3, 0.3]]}}},
      "meshes": {"plane": {"file": "tilted.obj"}}, "objects": [{"mesh": "plane", "displacement": "bump"}]})");
    const CommandResult result = run({"render", "shot.json", "-o", "s.exr"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const size_t first = result.errors.find("leave the unit square");
    ASSERT_NE(first, std::string::npos) << result.errors;
    EXPECT_EQ(result.errors.find("leave the unit square", first + 1), std::string::npos) << result.errors;
    EXPECT_NE(result.errors.find("\"wrap\": \"repeat\""), std::string::npos) << result.errors;
    EXPECT_EQ(result.errors.find("--wrap"), std::string::npos) << result.errors;
    EXPECT_EQ(run({"render", "shot.json", "-o", "t.exr", "--strict"}).exit_code, 6);
    EXPECT_FALSE(exists("t.0001.exr"));
}

TEST_F(FramesTest, go_with_no_options_of_one_picture) {
    const auto expect_refused = [&](const std::vector<std::string>& more) {
        std::vector<std::string> command = {"render", "shot.json", "-o", "no.exr"};
        command.insert(command.end(), more.begin(), more.end());
        const CommandResult result = run(command);
        EXPECT_EQ(result.exit_code, 2) << more[0] << result.errors;
        EXPECT_FALSE(exists("no.0001.exr"));
    };
    expect_refused({"--stats", "s.json"});
    expect_refused({"--turntable", "3"});
    expect_refused({"--checkpoint", "1"});
    expect_refused({"--frames", "3-1"});
    expect_refused({"--skip-existing", "-o", "no.png"});
    EXPECT_EQ(run({"render", "plane.obj", "--frames", "1-2", "-o", "m.exr"}).exit_code, 2);
    EXPECT_EQ(run({"render", "plane.obj", "--skip-existing", "-o", "m.exr"}).exit_code, 2);
    write("still.json", R"({"meshes": {"plane": {"file": "plane.obj"}}, "objects": [{"mesh": "plane"}]})");
    EXPECT_EQ(run({"render", "still.json", "--skip-existing", "-o", "m.exr"}).exit_code, 2);
}

TEST_F(FramesTest, have_names_by_one_rule) {
    const auto render_third = [&](const std::vector<std::string>& more) {
        std::vector<std::string> all = {"render", "shot.json", "--frames", "3"};
        all.insert(all.end(), more.begin(), more.end());
        return run(all);
    };
    for (const char* name : {"c.exr", "c.####.exr", "c.0003.exr"}) {
        ASSERT_EQ(render_third({"-o", name, "--checkpoint", "1"}).exit_code, 0);
        EXPECT_TRUE(exists("c.0003.exr") && exists("c.0003.exr.film")) << name;
        for (const char* resumed : {"c.exr", "c.####.exr", "c.0003.exr"}) {
            const CommandResult result = render_third({"--resume", resumed, "--spp", "3"});
            EXPECT_EQ(result.exit_code, 0) << resumed << result.errors;
            EXPECT_EQ(result.output, "wrote c.0003.exr\n");
        }
        std::filesystem::remove(folder_ / "c.0003.exr"), std::filesystem::remove(folder_ / "c.0003.exr.film");
    }
    EXPECT_EQ(render_third({"-o", "d.0001.exr"}).output, "wrote d.0001.0003.exr\n") << "of another frame";
    const CommandResult several = run({"render", "shot.json", "--frames", "2-3", "-o", "e.0003.exr"});
    EXPECT_EQ(several.exit_code, 2);
    EXPECT_TRUE(contains(several.errors, "hint: -o e.####.exr")) << several.errors;
    EXPECT_EQ(run({"render", "plane.obj", "--size", "8x8", "--spp", "1", "-o", "m.####.exr"}).output,
              "wrote m.0001.exr\n");
}

TEST_F(FramesTest, are_named_where_a_name_without_number_is_read) {
    ASSERT_EQ(run({"render", "shot.json", "-o", "s.exr"}).exit_code, 0);
    ASSERT_EQ(run({"render", "shot.json", "--frames", "7", "-o", "one.exr"}).exit_code, 0);
    const std::string all = "did you mean one of its 3 frames, from 's.0001.exr' to 's.0003.exr'?";
    const std::vector<std::vector<std::string>> commands = {{"compare", "s.exr", "one.0007.exr"},
                                                            {"compare", "one.0007.exr", "s.####.exr"},
                                                            {"merge", "s.exr", "-o", "m.exr"},
                                                            {"inspect", "s.exr"},
                                                            {"convert", "s.exr", "-o", "m.exr"}};
    for (const std::vector<std::string>& command : commands) {
        const CommandResult result = run(command);
        EXPECT_EQ(result.exit_code, 3) << command[0];
        EXPECT_TRUE(contains(result.errors, all)) << command[0] << ": " << result.errors;
    }
    EXPECT_TRUE(contains(run({"compare", "one.exr", "s.0001.exr"}).errors, "did you mean 'one.0007.exr'?"));
    const CommandResult resumed = run({"render", "plane.obj", "--resume", "s.exr"});
    EXPECT_EQ(resumed.exit_code, 3);
    EXPECT_TRUE(contains(resumed.errors, all)) << resumed.errors;
    const CommandResult merged = run({"merge", "s.0001.exr", "-o", "m.####.exr"});
    EXPECT_EQ(merged.exit_code, 2);
    EXPECT_TRUE(contains(merged.errors, "a joined picture has no number of a frame")) << merged.errors;
}

} // namespace
} // namespace relief::cli
