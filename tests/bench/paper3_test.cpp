#include "bench/paper3.h"

#include <gtest/gtest.h>

#include "bench/tables.h"
#include "relief/error.h"

namespace relief::bench {
namespace {

Value run_quick_paper3(const std::string& scene) {
    Paper3Options options;
    options.scenes = {scene};
    return run_paper3(make_quick_options(options), [](const std::string&) {});
}

TEST(Paper3, the_four_pairs_make_the_same_picture) {
    const Value result = run_quick_paper3("hall");
    const Value& ways = result["scenes"][0]["ways"];
    ASSERT_EQ(ways.size(), 4u);
    for (const Value& way : ways) {
        EXPECT_EQ(way["outcome"], "measured");
        EXPECT_EQ(way["method"], "compute");
        EXPECT_EQ(way["pixels_that_differ"], 0);
        EXPECT_EQ(way["camera_rays"], 32 * 18);
        EXPECT_GT(way["shadow_rays"], 0);
        EXPECT_LE(way["shadow_rays"], 32 * 18);
        EXPECT_GT(way["structures_bytes"], 0);
    }
    EXPECT_EQ(ways[0]["traversal"], "push-down");
    EXPECT_EQ(ways[3]["traversal"], "parent-link");
    EXPECT_TRUE(result["goals"][0]["met"].get<bool>());
}

TEST(Paper3, what_is_refused_has_no_row) {
    Value result = run_quick_paper3("body");
    const size_t rows = make_paper3_table(result).rows.size();
    ASSERT_EQ(rows, 4u * 11);
    result["scenes"][0]["ways"][1] = {{"structure", "kdtree"},
                                      {"traversal", "backtrack"},
                                      {"method", "hybrid"},
                                      {"outcome", "refused"},
                                      {"reason", "a reason"}};
    const Table table = make_paper3_table(result);
    EXPECT_EQ(table.rows.size(), rows - 11);
    EXPECT_EQ(write_csv(table).find("backtrack"), std::string::npos);
}

TEST(Paper3, knows_its_scenes) { EXPECT_THROW(run_quick_paper3("bunny"), Error); }

} // namespace
} // namespace relief::bench
