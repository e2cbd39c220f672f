#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace relief {
namespace {

TEST(Parallel, covers_every_index_once_in_ranges_no_longer_than_the_grain) {
    for (const size_t count : {size_t(0), size_t(1), size_t(7), size_t(1000)})
        for (const size_t grain : {size_t(1), size_t(16), size_t(5000)}) {
            std::vector<std::atomic<int>> seen(count);
            std::atomic<bool> is_short{true};
            parallel_for("cover", count, grain, [&](size_t begin, size_t end) {
                if (end - begin > grain) is_short = false;
                for (size_t k = begin; k < end; ++k) ++seen[k];
            });
            EXPECT_TRUE(is_short);
            for (const std::atomic<int>& times : seen) EXPECT_EQ(times, 1);
        }
}

TEST(Parallel, passes_exceptions_on_to_the_caller) {
    const auto fail_at_70 = [](size_t begin, size_t end) {
        if (begin <= 70 && 70 < end) throw std::runtime_error("seventy");
    };
    try {
        parallel_for("fail", 100, 4, fail_at_70);
        FAIL() << "no exception";
    } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "seventy");
    }
    EXPECT_THROW(parallel_invoke([] {}, [] { throw std::runtime_error("second"); }), std::runtime_error);
}

TEST(Parallel, never_runs_two_bodies_with_one_thread_index_at_a_time) {
    with_threads(4, [] {
        ASSERT_GE(thread_count(), 1);
        std::vector<std::atomic<int>> busy(static_cast<size_t>(thread_count()));
        std::atomic<bool> is_alone{true}, is_in_range{true};
        parallel_for("index", 20000, 1, [&](size_t, size_t) {
            const int index = current_thread_index();
            if (index < 0 || index >= int(busy.size())) {
                is_in_range = false;
                return;
            }
            if (busy[size_t(index)].fetch_add(1) != 0) is_alone = false;
            busy[size_t(index)].fetch_sub(1);
        });
        EXPECT_TRUE(is_in_range);
        EXPECT_TRUE(is_alone);
    });
}

TEST(Parallel, keeps_to_the_number_of_threads_asked_for) {
    for (const int threads : {1, 3}) with_threads(threads, [&] { EXPECT_EQ(thread_count(), threads); });
    with_threads(0, [] { EXPECT_GE(thread_count(), 1); });
}

TEST(Parallel, invokes_both_functions) {
    std::atomic<int> calls{0};
    parallel_invoke([&] { calls += 1; }, [&] { calls += 10; });
    EXPECT_EQ(calls, 11);
}

TEST(Parallel, works_inside_itself) {
    std::atomic<int> sum{0};
    parallel_for("outer", 20, 1, [&](size_t, size_t) {
        parallel_for("inner", 30, 7, [&](size_t begin, size_t end) { sum += int(end - begin); });
    });
    EXPECT_EQ(sum, 600);
}

} // namespace
} // namespace relief
