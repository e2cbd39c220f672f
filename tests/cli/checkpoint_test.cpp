// --checkpoint and --resume: a command that is killed loses little; what cannot be gone on with is refused.
// --denoise without the library.
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "command.h"
#include "relief/io.h"

namespace relief::cli {
namespace {

class Checkpoint : public CommandTest {
  protected:
    CommandResult render(const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"render",    "plane.obj", "--size",     "96x64",
                                           "--bounces", "1",         "--progress", "none"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    }
};

TEST_F(Checkpoint, a_killed_render_goes_on_to_the_same_bits) {
    const pid_t process = start({"render", "plane.obj", "--size", "96x64", "--bounces", "1", "--spp",
                                 "1048576", "--checkpoint", "0.001", "-o", "a.exr"});
    for (int k = 0; k < 4000 && !exists("a.exr.film"); ++k)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
    kill(process, SIGKILL);
    EXPECT_EQ(finish(process).exit_code, 128 + SIGKILL);
    EXPECT_FALSE(exists("a.exr"));
    ASSERT_TRUE(exists("a.exr.film"));
    EXPECT_EQ(render({"--spp", "1024", "--resume", "a.exr"}).exit_code, 0);
    const Image resumed = read_image(folder_ / "a.exr");
    const int samples = int(resumed.at(0, 0, resumed.find_channel("samples.Y").value()));
    EXPECT_GE(samples, 1024);
    EXPECT_EQ(render({"--spp", std::to_string(samples), "-o", "b.exr"}).exit_code, 0);
    EXPECT_EQ(run({"compare", "a.exr", "b.exr"}).exit_code, 0);
}

TEST_F(Checkpoint, tells_what_cannot_be_gone_on_with) {
    EXPECT_EQ(render({"--spp", "2", "-o", "a.exr"}).exit_code, 0);
    CommandResult result = render({"--spp", "4", "--resume", "a.exr"});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_NE(result.errors.find("a.exr.film"), std::string::npos) << result.errors;
    EXPECT_EQ(render({"--spp", "2", "--checkpoint", "5", "-o", "a.exr"}).exit_code, 0);
    result = render({"--spp", "4", "--seed", "3", "--resume", "a.exr"});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_NE(result.errors.find("of another picture: seed 3 (there: seed 0)"), std::string::npos)
        << result.errors;
    result = render({"--spp", "2", "--resume", "a.exr"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.errors.find("had 2 samples already"), std::string::npos) << result.errors;
    EXPECT_EQ(render({"--spp", "4", "--resume", "a.exr", "--stats", "a.exr.film"}).exit_code, 2);
    result = render({"--spp", "2", "--checkpoint", "5", "-o", "a.exr"});
    EXPECT_NE(result.errors.find("a.exr.film is replaced"), std::string::npos) << result.errors;
}

TEST_F(Checkpoint, a_denoiser_that_is_not_there_is_missed_before_the_scene_is_read) {
    const CommandResult result = finish(start({"render", "no.obj", "--denoise", "-o", "a.png"},
                                              [] { setenv("RELIEF_OIDN", "/nowhere/at/all", 1); }));
    EXPECT_EQ(result.exit_code, 4) << result.errors;
    EXPECT_NE(result.errors.find("RELIEF_OIDN"), std::string::npos) << result.errors;
}

} // namespace
} // namespace relief::cli
