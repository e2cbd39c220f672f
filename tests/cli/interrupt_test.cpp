// Interrupts before and after the first pass over the picture, and samples beyond those of the scene file.
#include <chrono>
#include <csignal>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command.h"
#include "relief/io.h"

namespace relief::cli {
namespace {

class Interrupt : public CommandTest {
  protected:
    /// Interrupts the command when its errors hold `part`.
    CommandResult interrupt_at(const std::vector<std::string>& arguments, const std::string& part) {
        const pid_t process = start(arguments);
        for (int k = 0; k < 2000 && read("stderr.txt").find(part) == std::string::npos; ++k)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        kill(process, SIGINT);
        return finish(process);
    }
};

TEST_F(Interrupt, before_every_pixel_has_a_sample_writes_no_picture) {
    const CommandResult result =
        interrupt_at({"render", "plane.obj", "--size", "2048x1152", "--spp", "64", "--threads", "1",
                      "--progress", "json", "--stats", "s.json", "-o", "black.exr"},
                     "percent");
    EXPECT_EQ(result.exit_code, 130) << result.errors;
    EXPECT_NE(result.errors.find("before every pixel had a sample; no picture was written"),
              std::string::npos)
        << result.errors;
    EXPECT_FALSE(exists("black.exr"));
    const nlohmann::json statistics = nlohmann::json::parse(read("s.json"));
    EXPECT_GT(statistics["rays"]["camera"], 0) << "the first pass had begun";
    EXPECT_LT(statistics["rays"]["camera"], 2048 * 1152) << "and was not done";
}

TEST_F(Interrupt, after_the_first_pass_writes_a_picture_that_is_whole) {
    const CommandResult result = interrupt_at({"render", "plane.obj", "--size", "64x64", "--spp", "1048576",
                                               "--bounces", "0", "--progress", "json", "-o", "part.exr"},
                                              "percent");
    EXPECT_EQ(result.exit_code, 130) << result.errors;
    const Image image = read_image(folder_ / "part.exr");
    const size_t samples = image.find_channel("samples.Y").value();
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) ASSERT_GE(image.at(x, y, samples), 1);
}

/// `side` x `side` quads, each with the whole map.
std::string make_grid(int side) {
    std::string text = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
    for (int y = 0; y <= side; ++y)
        for (int x = 0; x <= side; ++x) text += fmt::format("v {} {} 0\n", x, y);
    for (int y = 0; y < side; ++y)
        for (int x = 0, first = 1 + y * (side + 1); x < side; ++x, ++first)
            text +=
                fmt::format("f {}/1 {}/2 {}/3 {}/4\n", first, first + 1, first + side + 2, first + side + 1);
    return text;
}

/// A level that takes seconds to prepare: the signal comes long before the first ray.
TEST_F(Interrupt, while_surfaces_are_prepared_ends_at_once) {
    write("grid.obj", make_grid(6));
    const pid_t process =
        start({"render", "grid.obj", "--subdivision", "catmark", "--subdivision-level", "8", "--vdm",
               "bump.exr", "--preset", "cycles", "--size", "64x64", "--spp", "1048576", "-o", "no.png"});
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    kill(process, SIGTERM);
    const CommandResult result = finish(process);
    EXPECT_EQ(result.exit_code, 143) << result.errors;
    EXPECT_NE(result.errors.find("interrupted before the first ray; no picture was written"),
              std::string::npos)
        << result.errors;
    EXPECT_FALSE(exists("no.png"));
}

TEST_F(Interrupt, samples_go_beyond_the_scene_file_but_not_beyond_the_command_line) {
    write("scene.json", R"({"render": {"width": 8, "height": 8, "spp": 4}, "environment": {},
        "meshes": {"p": {"file": "plane.obj"}}, "objects": [{"mesh": "p"}]})");
    EXPECT_EQ(run({"render", "scene.json", "--samples", "4:6", "-o", "a.exr"}).exit_code, 0);
    EXPECT_EQ(read_image(folder_ / "a.exr").metadata.at("relief:samples"), "4:6");
    EXPECT_EQ(run({"render", "scene.json", "--samples", "4:6", "--spp", "4", "-o", "b.exr"}).exit_code, 2);
    EXPECT_FALSE(exists("b.exr"));
}

} // namespace
} // namespace relief::cli
