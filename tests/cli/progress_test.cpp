// Progress of commands that are no render.
#include <sstream>

#include <nlohmann/json.hpp>

#include "command.h"

namespace relief::cli {
namespace {

using nlohmann::json;

class WorkProgressOfCommands : public CommandTest {
  protected:
    std::vector<json> list_lines(std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"--progress", "json"});
        const CommandResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        std::vector<json> lines;
        std::istringstream stream(result.errors);
        for (std::string line; std::getline(stream, line);) lines.push_back(json::parse(line));
        return lines;
    }

    /// Percents grow from below to 100, with times, and nothing of a render.
    void expect_progress(const std::vector<std::string>& arguments, size_t least_lines) {
        std::vector<json> lines = list_lines(arguments);
        std::erase_if(lines, [](const json& line) { return line["percent"].is_null(); }); // a slow reader
        ASSERT_GE(lines.size(), least_lines) << arguments[0];
        double before = 0;
        for (const json& line : lines) {
            EXPECT_GE(line["percent"], before) << arguments[0];
            before = line["percent"];
            EXPECT_TRUE(line["elapsed_s"].is_number() && line.contains("left_s"));
            EXPECT_FALSE(line.contains("samples") || line.contains("rays"));
        }
        EXPECT_LT(lines.front()["percent"], 100);
        EXPECT_NEAR(before, 100, 1e-9) << arguments[0];
    }
};

TEST_F(WorkProgressOfCommands, grows_to_the_end_and_is_silent_on_request) {
    expect_progress({"scene", "ear", "-o", "ear"}, 2);
    expect_progress({"inspect", "ear/scene.json"}, 4);
    expect_progress({"inspect", "bump.exr"}, 2);
    expect_progress({"inspect", "plane.obj", "--vdm", "bump.exr"}, 4);
    expect_progress({"convert", "bump.exr", "--mesh", "plane.obj", "--to-space", "object", "-o", "o.exr"}, 3);
    EXPECT_EQ(run({"inspect", "bump.exr", "--progress", "json", "-q"}).errors, "");
    EXPECT_EQ(run({"convert", "bump.exr", "-o", "o.exr", "--progress", "json", "-q"}).errors, "");
    expect_progress({"convert", "ear/scene.json", "--level", "4", "-o", "ear.ply"}, 3);
}

TEST_F(WorkProgressOfCommands, of_measurements_names_the_steps) {
    const std::vector<json> lines =
        list_lines({"bench", "paper2", "--quick", "--scenes", "body", "-o", "p2"});
    ASSERT_FALSE(lines.empty());
    EXPECT_EQ(lines.front()["step"], "making the mesh body");
    EXPECT_TRUE(lines.front()["percent"].is_null()) << "the number of steps is not known";
    const CommandResult plain = run({"bench", "paper2", "--quick", "--scenes", "body", "-o", "p3"});
    EXPECT_NE(plain.errors.find("making the mesh body  0:0"), std::string::npos) << plain.errors;
}

TEST_F(WorkProgressOfCommands, of_a_moment_is_not_told_unless_asked_for) {
    EXPECT_EQ(run({"convert", "plane.obj", "-o", "plane.ply"}).errors, "");
    const CommandResult asked = run({"convert", "plane.obj", "-o", "plane.ply", "--progress", "bar"});
    EXPECT_EQ(asked.errors, "") << "a bar of a moment would only flash";
    EXPECT_EQ(run({"inspect", "plane.obj", "--progress", "dots"}).exit_code, 2);
}

} // namespace
} // namespace relief::cli
