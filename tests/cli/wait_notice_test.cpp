// The line that tells of a render before its first ray.
#include <chrono>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "wait_notice.h"

namespace relief::cli {
namespace {

constexpr std::chrono::milliseconds kLong{1300};

ProgressOptions make_plain() {
    ProgressOptions options;
    options.style = ProgressStyle::plain;
    return options;
}

TEST(WaitNotice, is_printed_after_a_second_and_never_after_its_stop) {
    ProgressPrinter printer(make_plain());
    testing::internal::CaptureStderr();
    {
        WaitNotice notice(printer, "preparing");
        std::this_thread::sleep_for(kLong);
        notice.stop();
        EXPECT_NE(testing::internal::GetCapturedStderr().find("preparing  0:01 elapsed\n"),
                  std::string::npos);
        testing::internal::CaptureStderr();
        std::this_thread::sleep_for(kLong);
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(WaitNotice, waits_while_something_else_is_printed) {
    ProgressPrinter printer(make_plain());
    testing::internal::CaptureStderr();
    WaitNotice notice(printer, "preparing");
    {
        const auto lock = notice.interject();
        std::this_thread::sleep_for(kLong);
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
        testing::internal::CaptureStderr();
    }
    notice.stop();
    testing::internal::GetCapturedStderr();
}

} // namespace
} // namespace relief::cli
