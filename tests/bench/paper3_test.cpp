#include "bench/paper3.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "relief/error.h"
#include "support/xml.h"

namespace relief::bench {
namespace {

using Json = nlohmann::ordered_json;

Json run_quick(const std::string& scene) {
    Paper3Options options;
    options.scenes = {scene};
    return run_paper3(make_quick_options(options), [](const std::string&) {});
}

TEST(Paper3, the_four_pairs_make_the_same_picture) {
    const Json result = run_quick("hall");
    const Json& ways = result["scenes"][0]["ways"];
    ASSERT_EQ(ways.size(), 4u);
    for (const Json& way : ways) {
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
    EXPECT_TRUE(result["goals"][0]["met"]);
}

TEST(Paper3, writes_a_chart_of_each_scene) {
    const std::vector<ReportFile> files = make_paper3_files(run_quick("body"));
    ASSERT_EQ(files.size(), 4u);
    EXPECT_EQ(files[3].name, "paper3_body.svg");
    for (const size_t chart : {2, 3})
        EXPECT_EQ(test::find_xml_fault(files[chart].text), "") << files[chart].name;
}

TEST(Paper3, what_is_refused_is_shown_with_its_reason) {
    Json result = run_quick("body");
    Json& way = result["scenes"][0]["ways"][1];
    way = {{"structure", "kdtree"},
           {"traversal", "backtrack"},
           {"method", "hybrid"},
           {"outcome", "refused"},
           {"reason", "a reason"}};
    const std::vector<ReportFile> files = make_paper3_files(result);
    EXPECT_NE(files[3].text.find("refused"), std::string::npos);
    EXPECT_EQ(files[1].text.find("backtrack"), std::string::npos);
}

TEST(Paper3, knows_its_scenes) { EXPECT_THROW(run_quick("bunny"), Error); }

} // namespace
} // namespace relief::bench
