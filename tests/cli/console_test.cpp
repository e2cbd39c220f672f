// Streams that cannot be written: nothing aborts, and lost results cost the exit code. Disks that fill while
// a farm works: the reason is in its status.
#include <filesystem>
#include <string>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "command.h"
#include "relief/io.h"
#include "small_disk.h"

namespace relief::cli {
namespace {

void lose(int descriptor) { dup2(open("/dev/full", O_WRONLY), descriptor); }

class Console : public CommandTest {
  protected:
    int run_with(const std::vector<std::string>& arguments, const std::function<void()>& prepare) {
        return finish(start(arguments, prepare)).exit_code;
    }
    int render_with(const std::string& output, const std::function<void()>& prepare) {
        return run_with({"render", "plane.obj", "--size", "8x8", "--spp", "1", "-o", output}, prepare);
    }
};

TEST_F(Console, errors_that_cannot_be_written_leave_the_exit_code_as_it_is) {
    const auto fill = [] { lose(STDERR_FILENO); };
    const auto close_it = [] { close(STDERR_FILENO); };
    EXPECT_EQ(run_with({"render", "nowhere.obj"}, fill), 3);
    EXPECT_EQ(run_with({"render", "nowhere.obj"}, close_it), 3);
    EXPECT_EQ(run_with({"rendr"}, fill), 2);
    EXPECT_EQ(run_with({"rendr"}, close_it), 2);
    EXPECT_EQ(render_with("a.exr", fill), 0);
    EXPECT_EQ(read_image(folder_ / "a.exr").width, 8);
}

TEST_F(Console, lost_output_is_a_failure) {
    ASSERT_EQ(render_with("a.exr", [] {}), 0);
    const std::vector<std::vector<std::string>> commands = {{"--help"},
                                                            {"--version"},
                                                            {"render", "--help"},
                                                            {"farm", "plan", "--help-all"},
                                                            {"bench", "--help"},
                                                            {"inspect", "plane.obj", "--json"},
                                                            {"compare", "a.exr", "a.exr", "--json"},
                                                            {"devices"}};
    for (const std::vector<std::string>& command : commands) {
        const CommandResult result = finish(start(command, [] { lose(STDOUT_FILENO); }));
        EXPECT_EQ(result.exit_code, 1) << command.front();
        EXPECT_TRUE(contains(result.errors, "standard output cannot be written: No space left"))
            << result.errors;
        EXPECT_EQ(run_with(command, [] { close(STDOUT_FILENO); }), 1) << command.front();
    }
    EXPECT_EQ(run_with({"rendr"}, [] { lose(STDOUT_FILENO); }), 2) << "another failure keeps its code";
}

TEST_F(Console, a_picture_is_whole_without_any_stream) {
    const auto close_all = [] {
        for (int descriptor = 0; descriptor < 3; ++descriptor) close(descriptor);
    };
    EXPECT_EQ(render_with("a.exr", close_all), 1) << "the line with its name is lost";
    EXPECT_EQ(read_image(folder_ / "a.exr").height, 8) << "no text is written into its file";
}

TEST_F(Console, a_reader_that_goes_away_ends_nothing) {
    program_ = "/bin/sh";
    const auto pipe_to_nobody = [&](const char* streams, const char* picture) {
        const std::string line =
            fmt::format("({} render plane.obj --size 8x8 --spp 1 -o {} --progress json {}; "
                        "echo $? >code) | true; sleep 0.2; cat code",
                        RELIEF_BINARY, picture, streams);
        return run({"-c", line}).output;
    };
    EXPECT_EQ(pipe_to_nobody("2>&1 >/dev/null", "a.exr"), "0\n");
    EXPECT_TRUE(exists("a.exr"));
}

/// A shot of one frame, whose job folder is a disk of 256 KiB.
class FullFarm : public Console {
  protected:
    /// `room`: KiB that are free when the tasks begin. Returns the exit code of `submit`.
    int run_farm(int room) {
        write("scene.json", R"({"version": 1, "render": {"width": 96, "height": 96, "spp": 1},
            "meshes": {"m": {"file": "plane.obj"}}, "objects": [{"mesh": "m"}]})");
        std::filesystem::create_directory(folder_ / "job");
        program_ = "/bin/sh";
        const std::string script = fmt::format("{0} farm plan scene.json --frames 1 -o job || exit 99\n"
                                               "head -c {1} /dev/zero >job/room\n"
                                               "cat /dev/zero >job/fill 2>/dev/null\n"
                                               "rm job/room\n"
                                               "{0} farm submit job --progress none; echo $? >submitted\n"
                                               "{0} farm status job >status.txt\n"
                                               "{0} farm work job --task 0 --log 2>work.txt\n",
                                               RELIEF_BINARY, room * 1024);
        const CommandResult result = finish(start({"-c", script}, [] {
            if (!mount_small_disk("job", "size=256k")) _exit(kNoSmallDisk);
        }));
        errors_ = result.errors;
        if (result.exit_code == kNoSmallDisk) return kNoSmallDisk;
        return std::stoi(read("submitted"));
    }
    std::string errors_;
};

TEST_F(FullFarm, tells_why_a_film_cannot_be_kept) {
    const int submitted = run_farm(24);
    if (submitted == kNoSmallDisk) GTEST_SKIP() << "no small disk can be made here";
    EXPECT_EQ(submitted, 3) << errors_;
    const std::string status = read("status.txt");
    EXPECT_TRUE(contains(status, "1 failed")) << status;
    EXPECT_TRUE(contains(status, "No space left on device")) << status;
    EXPECT_TRUE(contains(errors_, "No space left on device")) << errors_;
}

TEST_F(FullFarm, tells_why_a_task_cannot_even_begin) {
    const int submitted = run_farm(0);
    if (submitted == kNoSmallDisk) GTEST_SKIP() << "no small disk can be made here";
    EXPECT_EQ(submitted, 3) << errors_;
    const std::string status = read("status.txt");
    EXPECT_TRUE(contains(status, "1 failed")) << status;
    EXPECT_TRUE(contains(status, "the disk of the job folder may be full")) << status;
    const std::string work = read("work.txt");
    EXPECT_TRUE(contains(work, "task 0 ended with exit code 1")) << work;
}

} // namespace
} // namespace relief::cli
