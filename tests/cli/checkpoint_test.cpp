// --checkpoint and --resume: a command that is killed loses little; what cannot be gone on with is refused.
// --denoise without the library.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string>
#include <thread>

#include <nlohmann/json.hpp>

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
    int find_most_samples(const char* name) {
        const Image image = read_image(folder_ / name);
        const size_t channel = image.find_channel("samples.Y").value();
        float most = 0;
        for (size_t at = channel; at < image.pixels.size(); at += image.channels.size())
            most = std::max(most, image.pixels[at]);
        return int(most);
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

/// An interrupt ends a render anywhere: what this asks for is a pass that is not done, with two samples more
/// at some pixels.
TEST_F(Checkpoint, tells_which_samples_of_an_unfinished_pass_stay) {
    const auto make_words = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"render", "plane.obj", "--size", "640x480", "--bounces", "1", "-q"});
        return more;
    };
    const auto render_large = [&](std::vector<std::string> more) { return run(make_words(std::move(more))); };
    int whole = 0, most = 0;
    for (int k = 1; k <= 40 && (whole == 0 || most < whole + 2); ++k) {
        const pid_t process = start(make_words(
            {"--spp", "4096", "--threads", "1", "--checkpoint", "5", "-o", "a.exr", "--stats", "s.json"}));
        std::this_thread::sleep_for(std::chrono::milliseconds(100 * k));
        kill(process, SIGINT);
        const CommandResult part = finish(process);
        ASSERT_EQ(part.exit_code, 130) << part.errors;
        const nlohmann::json image = nlohmann::json::parse(read("s.json"))["image"];
        whole = image["whole_samples"];
        ASSERT_LT(whole, 4096);
        EXPECT_EQ(image["is_complete"], false);
        if (whole > 0) most = find_most_samples("a.exr");
    }
    ASSERT_GE(most, whole + 2);
    const CommandResult less = render_large({"--spp", std::to_string(whole + 1), "--resume", "a.exr"});
    EXPECT_EQ(less.exit_code, 0);
    EXPECT_NE(less.errors.find("keep the " + std::to_string(most) + " samples"), std::string::npos)
        << less.errors;
    const CommandResult all = render_large({"--spp", std::to_string(most), "--resume", "a.exr"});
    EXPECT_EQ(all.exit_code, 0);
    EXPECT_EQ(all.errors.find("unfinished pass"), std::string::npos) << all.errors;
}

TEST_F(Checkpoint, says_that_a_time_limit_ended_a_render) {
    const CommandResult cut = run({"render", "plane.obj", "--size", "640x480", "--bounces", "1", "--spp",
                                   "4096", "--time-limit", "0.1", "-v", "-o", "a.exr"});
    EXPECT_EQ(cut.exit_code, 0) << cut.errors;
    EXPECT_NE(cut.errors.find("the time limit ended the render: each pixel has at least "), std::string::npos)
        << cut.errors;
    EXPECT_NE(cut.errors.find(" 4096 samples, "), std::string::npos) << cut.errors;
    EXPECT_EQ(run({"render", "plane.obj", "--size", "32x32", "--bounces", "1", "--spp", "2", "--time-limit",
                   "600", "-o", "b.exr"})
                  .errors.find("the time limit ended"),
              std::string::npos);
}

TEST_F(Checkpoint, a_limit_shorter_than_the_preparation_leaves_one_sample) {
    const CommandResult cut = run({"render", "plane.obj", "--size", "64x48", "--bounces", "1", "--spp", "64",
                                   "--time-limit", "0.001", "--stats", "s.json", "-o", "a.exr"});
    EXPECT_EQ(cut.exit_code, 0) << cut.errors;
    const nlohmann::json statistics = nlohmann::json::parse(read("s.json"));
    EXPECT_EQ(statistics["image"]["whole_samples"], 1);
    EXPECT_EQ(statistics["rays"]["camera"], 64 * 48) << "reading and preparing took the time";
    EXPECT_NE(cut.errors.find("each pixel has at least 1 of 64 samples"), std::string::npos) << cut.errors;
    EXPECT_NE(cut.errors.find("which the limit of 0.001 s does not shorten"), std::string::npos)
        << cut.errors;
}

TEST_F(Checkpoint, says_which_noise_was_reached) {
    const CommandResult none = render({"--spp", "32", "-o", "a.exr", "--stats", "s.json"});
    EXPECT_EQ(none.errors.find("noise"), std::string::npos) << "nobody asked: " << none.errors;
    EXPECT_FALSE(nlohmann::json::parse(read("s.json")).contains("noise"));
    const CommandResult few =
        render({"--spp", "16", "--noise", "0.000001", "-o", "a.exr", "--stats", "s.json"});
    EXPECT_NE(few.errors.find("of 6144 pixels ("), std::string::npos) << few.errors;
    EXPECT_NE(few.errors.find("reached 1e-06; half of the other "), std::string::npos) << few.errors;
    EXPECT_NE(few.errors.find("hint: --spp is the most samples that a pixel gets, 16 here"),
              std::string::npos)
        << few.errors;
    nlohmann::json noise = nlohmann::json::parse(read("s.json"))["noise"];
    EXPECT_EQ(noise["pixels"], 6144);
    EXPECT_LT(noise["reached_pixels"], 6144);
    EXPECT_GE(noise["most"], noise["median_of_others"]);
    EXPECT_GT(noise["median_of_others"], noise["asked"]);
    const CommandResult all = render({"--spp", "16", "--noise", "1", "-o", "a.exr", "--stats", "s.json"});
    EXPECT_NE(all.errors.find("noise: all 6144 pixels reached 1\n"), std::string::npos) << all.errors;
    EXPECT_EQ(all.errors.find("hint: --spp"), std::string::npos) << all.errors;
    EXPECT_EQ(nlohmann::json::parse(read("s.json"))["noise"]["reached_pixels"], 6144);
    EXPECT_EQ(render({"--spp", "16", "--noise", "1", "-q", "-o", "a.exr"}).errors, "");
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

/// Of noise: how many samples a pixel has is decided by what it needs, and by the most that were asked for.
TEST_F(Checkpoint, tells_of_noisy_pixels_that_have_more_samples_than_asked_for) {
    EXPECT_EQ(render({"--noise", "0.0001", "--spp", "64", "--checkpoint", "5", "-o", "a.exr"}).exit_code, 0);
    const CommandResult fewer = render({"--noise", "0.0001", "--spp", "48", "--resume", "a.exr"});
    EXPECT_EQ(fewer.exit_code, 0);
    EXPECT_NE(fewer.errors.find("no samples are added: pixels have 48 already"), std::string::npos)
        << fewer.errors;
    EXPECT_NE(fewer.errors.find("keep the up to 64 samples"), std::string::npos) << fewer.errors;
    const CommandResult same = render({"--noise", "0.0001", "--spp", "64", "--resume", "a.exr"});
    EXPECT_EQ(same.errors.find("keep the up to"), std::string::npos) << same.errors;
}

TEST_F(Checkpoint, tells_of_sums_of_samples_that_are_cut_off) {
    EXPECT_EQ(render({"--spp", "2", "--checkpoint", "5", "-o", "a.exr"}).exit_code, 0);
    const std::string sums = read("a.exr.film");
    write("a.exr.film", sums.substr(0, sums.size() / 2));
    const CommandResult result = render({"--spp", "4", "--resume", "a.exr"});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_NE(result.errors.find("error: a.exr.film: the sums of samples end too early"), std::string::npos)
        << result.errors;
    EXPECT_NE(result.errors.find("hint: the file is cut off"), std::string::npos) << result.errors;
}

TEST_F(Checkpoint, a_denoiser_that_is_not_there_is_missed_before_the_scene_is_read) {
    const CommandResult result = finish(start({"render", "no.obj", "--denoise", "-o", "a.png"},
                                              [] { setenv("RELIEF_OIDN", "/nowhere/at/all", 1); }));
    EXPECT_EQ(result.exit_code, 4) << result.errors;
    EXPECT_NE(result.errors.find("RELIEF_OIDN"), std::string::npos) << result.errors;
}

} // namespace
} // namespace relief::cli
