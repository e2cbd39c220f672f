// A picture that cannot be written to the requested path is not lost, nor is an existing file there.
#include <filesystem>
#include <string>
#include <vector>

#include <sys/stat.h>

#include "command.h"
#include "output.h"
#include "relief/error.h"
#include "relief/io.h"

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

TEST_F(Output, replaces_no_pipe) {
    ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    ASSERT_EQ(::mkfifo((folder_ / "pipe.png").c_str(), 0600), 0);
    const CommandResult result = render_bump("a.exr", {"--stats", "pipe"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.errors.find("pipe: is a device, a pipe or the like"), std::string::npos)
        << result.errors;
    EXPECT_FALSE(exists("a.exr")) << "before the render";
    EXPECT_EQ(render_bump("pipe.png", {}).exit_code, 1);
    EXPECT_TRUE(std::filesystem::is_fifo(folder_ / "pipe"));
    EXPECT_TRUE(std::filesystem::is_fifo(folder_ / "pipe.png"));
}

TEST_F(Output, refuses_devices_and_what_stands_for_a_stream) {
    // Only asked for: a program that is wrong here, run by root, would take the machine's own away.
    for (const char* name : {"/dev/null", "/dev/stdout", "/dev/fd/2", "/proc/self/fd/1"})
        EXPECT_THROW(check_text_writable(name), Error) << name;
}

} // namespace
} // namespace relief::cli
