// A picture that cannot be written where it was asked for is not lost.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "command.h"
#include "output.h"
#include "relief/error.h"

namespace relief::cli {
namespace {

using Path = std::filesystem::path;

class Output : public CommandTest {};

TEST_F(Output, goes_where_it_was_asked_for) {
    std::vector<Path> tried;
    const Saved saved = save_with_fallback({}, folder_ / "a.exr", {folder_ / "other"},
                                           [&](const Image&, const Path& file) { tried.push_back(file); });
    EXPECT_EQ(saved.file, folder_ / "a.exr");
    EXPECT_FALSE(saved.is_elsewhere);
    EXPECT_EQ(tried.size(), 1u);
}

TEST_F(Output, a_full_disk_sends_it_to_the_first_folder_that_takes_it) {
    const Saved saved =
        save_with_fallback({}, folder_ / "full" / "a.exr", {folder_ / "full too", folder_ / "free"},
                           [&](const Image&, const Path& file) {
                               if (file.parent_path() != folder_ / "free")
                                   throw Error(ErrorKind::failed, {"no space left", file, ""});
                           });
    EXPECT_EQ(saved.file, folder_ / "free" / "a.exr");
    EXPECT_TRUE(saved.is_elsewhere);
}

TEST_F(Output, overwrites_nothing_in_another_folder) {
    write("a.exr", "mine");
    const Saved saved =
        save_with_fallback({}, folder_ / "full" / "a.exr", {folder_}, [&](const Image&, const Path& file) {
            if (file.parent_path() == folder_ / "full")
                throw Error(ErrorKind::failed, {"no space left", file, ""});
        });
    EXPECT_EQ(saved.file, folder_ / "a-2.exr");
    EXPECT_EQ(read("a.exr"), "mine");
}

TEST_F(Output, the_first_failure_is_told_when_no_place_works) {
    const auto fail = [](const Image&, const Path& file) {
        throw Error(ErrorKind::failed, {"no space left", file.string(), ""});
    };
    try {
        save_with_fallback({}, folder_ / "a.exr", {folder_ / "b"}, fail);
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.where(), (folder_ / "a.exr").string());
    }
}

TEST_F(Output, statistics_go_into_a_pipe_that_stays_one) {
    const Path pipe = folder_ / "stats";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    std::string received;
    std::thread reader([&] {
        std::ifstream stream(pipe);
        received.assign(std::istreambuf_iterator<char>(stream), {});
    });
    const CommandResult result = render_bump("a.exr", {"--stats", "stats"});
    if (result.exit_code != 0) std::ofstream(pipe) << result.errors; // so that the reader ends
    reader.join();
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_TRUE(std::filesystem::is_fifo(pipe));
    EXPECT_EQ(nlohmann::json::parse(received)["image"]["spp"], 4);
}

} // namespace
} // namespace relief::cli
