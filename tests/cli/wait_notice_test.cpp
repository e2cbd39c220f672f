// The line that tells of a render before its first ray.
#include <chrono>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "reading_notice.h"
#include "wait_notice.h"

namespace relief::cli {
namespace {

using std::chrono::milliseconds;
constexpr milliseconds kFirst{20}, kNext{10}, kLong{200};

ProgressOptions make_plain() {
    ProgressOptions options;
    options.style = ProgressStyle::plain;
    return options;
}

/// What is on stderr once something is there, or after ten seconds.
std::string await_line() {
    std::string text;
    for (int k = 0; k < 100 && text.empty(); ++k) {
        std::this_thread::sleep_for(milliseconds(100));
        text = testing::internal::GetCapturedStderr();
        testing::internal::CaptureStderr();
    }
    return text;
}

TEST(WaitNotice, is_printed_until_its_stop) {
    ProgressPrinter printer(make_plain());
    testing::internal::CaptureStderr();
    WaitNotice notice(printer, "preparing", kFirst, kNext);
    EXPECT_EQ(await_line(), "preparing  0:00 elapsed\n");
    notice.stop();
    std::this_thread::sleep_for(kLong);
    const std::string before = testing::internal::GetCapturedStderr();
    testing::internal::CaptureStderr();
    printer.print({.fraction = -1, .elapsed_s = 9}, "other"); // nobody else prints
    EXPECT_EQ(before + testing::internal::GetCapturedStderr(), "other  0:09 elapsed\n");
}

TEST(WaitNotice, tells_which_file_is_being_read) {
    testing::internal::CaptureStderr();
    const std::string line = read_with_notice(
        make_plain(), "large.png", [] { return await_line(); }, kFirst);
    EXPECT_EQ(line, "reading large.png  0:00 elapsed\n");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    testing::internal::CaptureStderr();
    EXPECT_EQ(read_with_notice(
                  make_plain(), "small.png", [] { return 5; }, kLong),
              5);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(WaitNotice, waits_while_something_else_is_printed) {
    ProgressPrinter printer(make_plain());
    testing::internal::CaptureStderr();
    {
        WaitNotice notice(printer, "preparing", kLong, kNext);
        {
            const auto lock = notice.interject();
            std::this_thread::sleep_for(3 * kLong);
            EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
            testing::internal::CaptureStderr();
        }
        EXPECT_EQ(await_line(), "preparing  0:01 elapsed\n");
    }
    testing::internal::GetCapturedStderr();
}

TEST(WaitNotice, ends_at_once_where_nothing_was_printed) {
    ProgressPrinter printer(make_plain());
    const auto begin = std::chrono::steady_clock::now();
    { const WaitNotice notice(printer, "preparing", std::chrono::hours(1), kNext); }
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(60));
}

} // namespace
} // namespace relief::cli
