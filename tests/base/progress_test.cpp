// Parts of a work and counts of loops as one progress.
#include <vector>

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "base/progress.h"

namespace relief {
namespace {

TEST(Progress, of_parts_lies_within_them) {
    std::vector<double> told;
    const ProgressFunction whole = [&](double fraction) { told.push_back(fraction); };
    const ProgressFunction last = make_part(whole, 0.5, 1);
    make_part(last, 0, 0.5)(1), last(1);
    EXPECT_EQ(told, (std::vector<double>{0.75, 1}));
    EXPECT_FALSE(make_part({}, 0, 1)) << "nobody asks";
}

TEST(Progress, of_a_parallel_loop_grows_to_its_end) {
    std::vector<double> told;
    ProgressCounter counter([&](double fraction) { told.push_back(fraction); }, 10000);
    parallel_for("count", 10000, 16, [&](size_t begin, size_t end) { counter.add(end - begin); });
    ASSERT_FALSE(told.empty());
    EXPECT_EQ(told.back(), 1);
    for (size_t k = 1; k < told.size(); ++k) EXPECT_LE(told[k - 1], told[k]);
    ProgressCounter(ProgressFunction(), 3).add(3);
    ProgressCounter([](double) { FAIL() << "of nothing"; }, 0).add(0);
}

} // namespace
} // namespace relief
