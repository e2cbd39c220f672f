#include "bench/child_process.h"

#include <cstdlib>

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

TEST(ChildProcess, variables_replace_those_of_this_process_and_leave_the_others) {
    setenv("RELIEF_TEST_KEPT", "kept", 1);
    setenv("RELIEF_TEST_REPLACED", "old", 1);
    const ChildResult result = run_child({"/bin/sh", "-c", "env | grep RELIEF_TEST_ | sort"},
                                         {"RELIEF_TEST_REPLACED=new", "RELIEF_TEST_MORE=more"});
    std::vector<std::string> lines;
    for (const LogLine& line : result.lines) lines.push_back(line.text);
    EXPECT_EQ(lines, (std::vector<std::string>{"RELIEF_TEST_KEPT=kept", "RELIEF_TEST_MORE=more",
                                               "RELIEF_TEST_REPLACED=new"}));
}

TEST(ChildProcess, counts_the_work_of_the_program_and_not_the_time_that_it_waits) {
    EXPECT_LT(run_child({"/bin/sh", "-c", "sleep 0.3"}).processor_s, 0.2);
    const ChildResult busy =
        run_child({"/bin/sh", "-c", "k=0; while [ $k -lt 300000 ]; do k=$((k + 1)); done"});
    EXPECT_GT(busy.processor_s, 0.005);
}

TEST(ChildProcess, a_failure_names_the_command_and_the_end_of_its_output) {
    EXPECT_EQ(run_checked({"/bin/sh", "-c", "echo fine"}).lines.at(0).text, "fine");
    try {
        run_checked({"/bin/sh", "-c", "for k in 1 2 3 4 5 6 7 8 9; do echo line $k; done; exit 3"});
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_TRUE(error.where().starts_with("/bin/sh -c for k in")) << error.where();
        EXPECT_NE(error.message().find("exit code 3:\nline 2\n"), std::string::npos) << error.message();
        EXPECT_TRUE(error.message().ends_with("line 9")) << error.message();
    }
}

} // namespace
} // namespace relief::bench
