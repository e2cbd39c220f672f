#include "bench/measure.h"

#include <gtest/gtest.h>

#include "support/bodies.h"

namespace relief::bench {
namespace {

Scene make_scene() {
    Scene scene;
    scene.meshes.push_back(test::make_cube_sphere(2));
    Object object;
    object.mesh = 0;
    scene.objects.push_back(object);
    scene.environment = Environment{};
    scene.camera.from = {0, 0, 4};
    return scene;
}

Variant make_variant(const char* name) {
    Variant variant{name, {}, {}, {}};
    variant.settings.image.width = variant.settings.image.height = 8;
    variant.settings.image.spp = 1, variant.settings.image.bounces = 1;
    return variant;
}

TEST(Measure, takes_the_median_and_the_ends) {
    EXPECT_EQ(summarize({3, 1, 2})["median"], 2.0);
    const auto even = summarize({4, 1, 2, 10});
    EXPECT_EQ(even["median"], 3.0);
    EXPECT_EQ(even["lowest"], 1.0);
    EXPECT_EQ(even["highest"], 10.0);
    EXPECT_EQ(even["runs"], 4);
}

TEST(Measure, quartiles_lie_between_neighbours) {
    const auto five = summarize_quartiles({5, 1, 4, 2, 3});
    EXPECT_EQ(five["lower_quartile"], 2.0);
    EXPECT_EQ(five["median"], 3.0);
    EXPECT_EQ(five["upper_quartile"], 4.0);
    const auto four = summarize_quartiles({4, 1, 2, 10});
    EXPECT_EQ(four["lower_quartile"], 1.75);
    EXPECT_EQ(four["median"], 3.0);
    EXPECT_EQ(four["upper_quartile"], 5.5);
    EXPECT_EQ(four["lowest"], 1.0);
    EXPECT_EQ(four["highest"], 10.0);
    EXPECT_EQ(four["runs"], 4);
    EXPECT_EQ(summarize_quartiles({7})["upper_quartile"], 7.0);
}

TEST(Measure, warms_up_and_takes_the_variants_in_turn) {
    std::vector<Variant> variants = {make_variant("a"), make_variant("b")};
    std::vector<std::string> lines;
    measure_in_turn(make_scene(), 2, variants, [&](const std::string& line) { lines.push_back(line); });
    EXPECT_EQ(lines, (std::vector<std::string>{"a, warm-up", "b, warm-up", "a, run 1", "b, run 1", "a, run 2",
                                               "b, run 2"}));
    for (const Variant& variant : variants) EXPECT_EQ(variant.runs.size(), 2u);
}

TEST(Measure, what_is_refused_already_is_not_rendered) {
    std::vector<Variant> variants = {make_variant("a"), make_variant("b")};
    variants[0].refusal = "too large";
    measure_in_turn(make_scene(), 1, variants, [](const std::string&) {});
    EXPECT_TRUE(variants[0].runs.empty());
    EXPECT_EQ(variants[1].runs.size(), 1u);
}

TEST(Measure, tells_frames_and_casts) {
    std::vector<Variant> variants = {make_variant("a")};
    measure_in_turn(make_scene(), 3, variants, [](const std::string&) {});
    const auto frames = describe_frames(variants[0].runs);
    EXPECT_EQ(frames["frame_s"]["runs"], 3);
    EXPECT_GT(frames["stages_total_s"]["median"], 0.0);
    const auto casts = describe_casts(variants[0].runs);
    ASSERT_GE(casts.size(), 2u);
    EXPECT_EQ(casts[0]["kind"], "camera");
    EXPECT_EQ(casts[0]["rays"], 64);
    EXPECT_EQ(casts[1]["kind"], "shadow");
    EXPECT_EQ(casts[2]["kind"], "bounce");
}

} // namespace
} // namespace relief::bench
