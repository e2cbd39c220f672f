#include "bench/child_process.h"

#include <gtest/gtest.h>

#include "relief/error.h"

namespace relief::bench {
namespace {

TEST(ChildProcess, tells_lines_of_both_outputs_as_they_arrive) {
    const ChildResult result =
        run_child({"/bin/sh", "-c", "echo one; sleep 0.2; echo two >&2; printf three; exit 7"});
    EXPECT_EQ(result.exit_code, 7);
    ASSERT_EQ(result.lines.size(), 3u);
    EXPECT_EQ(result.lines[0].text, "one");
    EXPECT_EQ(result.lines[1].text, "two");
    EXPECT_EQ(result.lines[2].text, "three");
    EXPECT_GE(result.lines[1].seconds - result.lines[0].seconds, 0.1);
}

TEST(ChildProcess, a_signal_is_an_exit_code_above_128) {
    EXPECT_EQ(run_child({"/bin/sh", "-c", "kill -TERM $$"}).exit_code, 128 + 15);
}

TEST(ChildProcess, what_is_not_there_cannot_be_started) {
    EXPECT_THROW(run_child({"/nonexistent/program"}), Error);
    EXPECT_FALSE(find_program("no-such-program-anywhere"));
    EXPECT_TRUE(find_program("sh"));
}

} // namespace
} // namespace relief::bench
