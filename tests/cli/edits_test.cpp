// render --edits: pictures that follow a map while it changes.
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <thread>

#include <fcntl.h>
#include <unistd.h>

#include "command.h"
#include "relief/io.h"

namespace relief::cli {
namespace {

class Edits : public CommandTest {
  protected:
    void SetUp() override {
        CommandTest::SetUp();
        Image part;
        part.width = part.full_width = 8, part.height = part.full_height = 6;
        part.channels = {"R", "G", "B"};
        part.pixels.assign(8 * 6 * 3, 0.15f);
        write_image(part, folder_ / "part.exr");
        // With a camera of its own: that of a mesh alone depends on the map.
        write("scene.json", R"({"render": {"width": 24, "height": 16, "spp": 4, "bounces": 1},
            "camera": {"from": [0, 1, 4], "to": [0, 0, 0]}, "environment": {},
            "displacements": {"bump": {"file": "bump.exr"}}, "meshes": {"plane": {"file": "plane.obj"}},
            "objects": [{"mesh": "plane", "displacement": "bump"}]})");
        // The map with the part painted into it at (0, 0) and at (5, 9).
        Image map = read_image(folder_ / "bump.exr");
        for (const auto& [x, y] : {std::pair(0, 0), std::pair(5, 9)}) paint(map, x, y);
        write_image(map, folder_ / "painted.exr");
    }
    static void paint(Image& map, int x0, int y0) {
        for (int y = y0; y < y0 + 6; ++y)
            for (int x = x0; x < x0 + 8; ++x)
                for (size_t c = 0; c < 3; ++c) map.at(x, y, c) = 0.15f;
    }
    void expect_same(const std::string& a, const std::string& b) {
        const CommandResult result = run({"compare", a, b, "--threshold", "0", "--json"});
        EXPECT_EQ(result.exit_code, 0) << result.output << result.errors;
    }
    CommandResult render(const std::string& output, const std::vector<std::string>& more) {
        std::vector<std::string> arguments = {"render", "scene.json", "-o", output};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    }
    CommandResult follow(const std::string& lines) {
        write("edits.jsonl", lines);
        return render("a.exr", {"--edits", "edits.jsonl", "-v", "--stats", "stats.json"});
    }
};

TEST_F(Edits, next_picture_is_that_of_the_painted_map) {
    const CommandResult result = follow(R"({"at": [0, 0], "texels": "part.exr"}

{"displacement": "bump", "tile": 1001, "at": [5, 9], "texels": "part.exr", "output": "b.exr"}
)"
                                        R"({"at": [0, 0], "texels": "bump.exr", "output": "c.exr"})");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.output, "wrote a.exr\nwrote b.exr\nwrote c.exr\n");
    EXPECT_NE(result.errors.find("edit: 1 patches"), std::string::npos) << result.errors;
    EXPECT_TRUE(exists("stats.json"));
    ASSERT_EQ(render("plain.exr", {}).exit_code, 0);
    expect_same("a.exr", "plain.exr");
    expect_same("c.exr", "plain.exr");
    std::filesystem::rename(folder_ / "painted.exr", folder_ / "bump.exr");
    ASSERT_EQ(render("painted.exr", {}).exit_code, 0);
    expect_same("b.exr", "painted.exr");
    const CommandResult differs = run({"compare", "a.exr", "b.exr", "--threshold", "0.001"});
    EXPECT_EQ(differs.exit_code, 7);
}

TEST_F(Edits, mistakes_of_a_file_name_the_line_before_any_picture_is_made) {
    const auto expect_error = [&](const std::string& line, const std::string& reason, int exit_code = 3) {
        const std::string good = R"({"at": [0, 0], "texels": "part.exr", "output": "b.exr"})";
        const CommandResult result = follow(good + "\n" + line);
        EXPECT_EQ(result.exit_code, exit_code) << line;
        EXPECT_NE(result.errors.find("edits.jsonl, line 2"), std::string::npos) << result.errors;
        EXPECT_NE(result.errors.find(reason), std::string::npos) << result.errors;
        EXPECT_EQ(result.output, "");
        EXPECT_FALSE(exists("a.exr"));
    };
    expect_error("{", "no JSON");
    expect_error("[1]", "one JSON object");
    expect_error(R"({"at": [0, 0], "texel": "part.exr"})", "did you mean 'texels'");
    expect_error(R"({"at": [0, -1], "texels": "part.exr"})", "whole and not negative");
    expect_error(R"({"at": [0], "texels": "part.exr"})", "two numbers");
    expect_error(R"({"at": [0, 0]})", "'texels' must be a text");
    expect_error(R"({"at": [0, 0], "texels": "nothing.exr"})", "nothing.exr");
    expect_error(R"({"at": [60000, 0], "texels": "part.exr"})", "leave the map");
    expect_error(R"({"at": [0, 0], "texels": "part.exr", "displacement": "skin"})", "no such displacement");
    expect_error(R"({"at": [0, 0], "texels": "part.exr", "tile": 1002})", "no such tile");
    expect_error(R"({"at": [0, 0], "texels": "part.exr", "output": "nowhere/c.exr"})", "nowhere", 1);
    const std::string over = "would be written over";
    expect_error(R"({"at": [0, 0], "texels": "part.exr", "output": "part.exr"})", over, 2);
    expect_error(R"({"at": [0, 0], "texels": "part.exr", "output": "bump.exr"})", over, 2);
    write_image(read_image(folder_ / "part.exr"), folder_ / "b.exr"); // the good line writes it
    expect_error(R"({"at": [0, 0], "texels": "./b.exr"})", over, 2);
}

TEST_F(Edits, mistakes_on_standard_input_keep_what_was_done) {
    write("edits.jsonl", R"({"at": [0, 0], "texels": "part.exr", "output": "b.exr"})"
                         "\n{");
    const std::string lines = (folder_ / "edits.jsonl").string();
    const CommandResult result =
        finish(start({"render", "scene.json", "-o", "a.exr", "--edits", "-"},
                     [&lines] { dup2(open(lines.c_str(), O_RDONLY), STDIN_FILENO); }));
    EXPECT_EQ(result.exit_code, 3) << result.errors;
    EXPECT_NE(result.errors.find("standard input, line 2"), std::string::npos) << result.errors;
    EXPECT_EQ(result.output, "wrote a.exr\nwrote b.exr\n");
}

TEST_F(Edits, an_interrupt_ends_the_wait_for_the_next_one) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const pid_t process = start({"render", "scene.json", "-o", "a.exr", "--edits", "-"}, [&ends] {
        dup2(ends[0], STDIN_FILENO);
        close(ends[1]);
    });
    for (int k = 0; k < 2000 && read("stdout.txt").find("wrote a.exr") == std::string::npos; ++k)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    kill(process, SIGTERM);
    const CommandResult result = finish(process); // would wait for the pipe to be closed
    EXPECT_EQ(result.exit_code, 143) << result.errors;
    EXPECT_NE(result.errors.find("interrupted while it waited for edits"), std::string::npos)
        << result.errors;
    close(ends[0]), close(ends[1]);
}

TEST_F(Edits, paths_start_from_the_current_folder) {
    std::filesystem::create_directory(folder_ / "elsewhere");
    write("elsewhere/edits.jsonl", R"({"at": [0, 0], "texels": "part.exr", "output": "b.exr"})");
    const CommandResult result = render("a.exr", {"--edits", "elsewhere/edits.jsonl"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_TRUE(exists("b.exr"));
}

TEST_F(Edits, command_line_mistakes) {
    EXPECT_EQ(run({"render", "plane.obj", "--edits", "nothing.jsonl"}).exit_code, 2);
    write("edits.jsonl", "");
    EXPECT_EQ(run({"render", "plane.obj", "--edits", "edits.jsonl", "--pixel", "1,1"}).exit_code, 2);
    EXPECT_EQ(run({"render", "plane.obj", "--vdm", "bump.exr", "--edits", "edits.jsonl", "--surface",
                   "tessellated", "-o", "a.exr"})
                  .exit_code,
              2);
}

} // namespace
} // namespace relief::cli
