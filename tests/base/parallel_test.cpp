#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "base/stop_request.h"

namespace relief {
namespace {

TEST(Parallel, for_covers_every_index_once_in_ranges_of_the_grain) {
    std::vector<int> visits(100'003, 0);
    std::atomic<size_t> odd_ranges{0};
    parallel_for("visit", visits.size(), 64, [&](size_t begin, size_t end) {
        const bool is_last = end == visits.size();
        if (begin % 64 != 0 || (is_last ? end - begin != visits.size() % 64 : end - begin != 64))
            ++odd_ranges;
        for (size_t i = begin; i < end; ++i) ++visits[i];
    });
    for (size_t i = 0; i < visits.size(); ++i) ASSERT_EQ(visits[i], 1) << i;
    EXPECT_EQ(odd_ranges.load(), 0u);
}

TEST(Parallel, for_with_a_grain_beyond_its_count_is_one_range) {
    for (const size_t grain : {size_t(10), size_t(11), SIZE_MAX - 3, SIZE_MAX}) {
        std::atomic<size_t> covered{0};
        parallel_for("one", 10, grain, [&](size_t begin, size_t end) { covered += 100 + end - begin; });
        EXPECT_EQ(covered.load(), 110u) << grain;
    }
}

TEST(Parallel, for_over_nothing_never_calls_its_body) {
    parallel_for("nothing", 0, 1, [](size_t, size_t) { ADD_FAILURE(); });
}

TEST(Parallel, an_exception_of_a_body_reaches_the_caller) {
    const auto fail_in_the_middle = [] {
        parallel_for("fail", 1000, 1, [](size_t begin, size_t) {
            if (begin == 500) throw std::runtime_error("body");
        });
    };
    EXPECT_THROW(fail_in_the_middle(), std::runtime_error);
}

TEST(Parallel, a_stop_ends_loops_within_its_scope_on_all_threads) {
    std::atomic<bool> is_stopped{false};
    const auto nest = [&](std::atomic<int>& bodies) {
        with_threads(3, [&] {
            parallel_for("outer", 8, 1, [&](size_t, size_t) {
                parallel_for("inner", 1000, 1, [&](size_t, size_t) {
                    if (++bodies == 100) is_stopped = true;
                });
            });
        });
    };
    std::atomic<int> stopped{0}, whole{0};
    {
        const StopScope scope([&] { return is_stopped.load(); });
        EXPECT_THROW(nest(stopped), StopRequest);
        const StopScope never({});
        EXPECT_NO_THROW(nest(whole));
    }
    EXPECT_LE(stopped, 100 + 8 * 3) << "work went on";
    EXPECT_EQ(whole, 8000);
    whole = 0, is_stopped = true;
    EXPECT_NO_THROW(nest(whole)) << "after the scope, also on threads that worked in it";
    EXPECT_EQ(whole, 8000);
}

TEST(Parallel, invoke_runs_both_and_nests) {
    std::vector<int> left(1000, 0), right(1000, 0);
    const auto fill = [](std::vector<int>& values, int value) {
        parallel_for("fill", values.size(), 10, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) values[i] = value;
        });
    };
    parallel_invoke([&] { fill(left, 1); }, [&] { fill(right, 2); });
    EXPECT_EQ(left, std::vector<int>(1000, 1));
    EXPECT_EQ(right, std::vector<int>(1000, 2));
}

TEST(Parallel, a_scope_bounds_threads_and_worker_indices) {
    for (const int threads : {1, 2, 3}) {
        std::atomic<int> highest{0};
        with_threads(threads, [&] {
            EXPECT_EQ(thread_count(), threads);
            parallel_for("index", 1000, 1, [&](size_t, size_t) {
                int seen = highest.load();
                const int index = current_thread_index();
                while (seen < index && !highest.compare_exchange_weak(seen, index)) {
                }
            });
        });
        EXPECT_LT(highest.load(), threads);
    }
}

} // namespace
} // namespace relief
