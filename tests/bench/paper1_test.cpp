// The figures of a result of paper1 follow from what was measured.
#include "bench/paper1.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bench/paper1_goals.h"
#include "bench/tables.h"
#include "relief/error.h"
#include "relief/inspect.h"
#include "relief/samples.h"

namespace relief::bench {
namespace {

Value make_summary(double value) {
    return {{"median", value}, {"lowest", value / 2}, {"highest", value * 2}, {"runs", 3}};
}

Value make_cast(int depth, const char* kind, double rays, double seconds) {
    return {{"depth", depth},
            {"kind", kind},
            {"rays", rays},
            {"stage_s", {{"sort", make_summary(seconds / 4)}}},
            {"total_s", make_summary(seconds)}};
}

Value make_frame(const char* name, double seconds) {
    return {{"name", name},
            {"outcome", "measured"},
            {"frame_s", make_summary(seconds)},
            {"prepare_s", make_summary(1)},
            {"stage_s", {{"sort", make_summary(seconds / 2)}}}};
}

Value make_row(const char* scene, double bytes_a_patch) {
    return {{"scene", scene},
            {"direct", {{"total_bytes", 1000}, {"bytes_a_patch", bytes_a_patch}}},
            {"tessellated_estimate", Value::list({{{"level", "5"}, {"total_bytes", 5000}}})},
            {"paper", {{"tessellated_bytes", 7e9}, {"direct_bytes", 2e6}}}};
}

/// Of two scenes on a device.
Value make_result() {
    Value result = {{"device", {{"engine", "vulkan"}}}};
    result["table1_1"] = Value::list({make_row("party", 48), make_row("bark", 80)});
    result["party"] = {{"peak_resident_bytes", uint64_t(600) << 20}, {"frame_s", make_summary(4e-3)}};
    result["figure1_7"] = Value::list(
        {{{"scene", "party"},
          {"variants",
           Value::list({make_frame("direct", 3),
                        {{"name", "tessellated"}, {"outcome", "refused"}, {"reason", "memory"}}})}},
         {{"scene", "bark"},
          {"variants", Value::list({make_frame("direct", 3), make_frame("tessellated", 2)})}}});
    result["figure1_9"] = Value::list();
    const Value casts = Value::list(
        {make_cast(1, "shadow", 1, 50), make_cast(1, "bounce", 100, 2), make_cast(5, "bounce", 10, 0.5)});
    result["figure1_10"] = Value::list(
        {{{"scene", "bark"}, {"variants", Value::list({{{"name", "direct"}, {"casts", casts}}})}}});
    return result;
}

/// -1 where there is no such goal.
double find_reached(const Value& goals, const std::string& part) {
    for (const Value& goal : goals)
        if (goal["name"].get<std::string>().find(part) != std::string::npos)
            return goal["reached"].get<double>();
    return -1;
}

TEST(Paper1, goals_follow_from_the_measures) {
    const Value goals = make_paper1_goals(make_result());
    EXPECT_DOUBLE_EQ(find_reached(goals, "worst scene"), 80);
    EXPECT_DOUBLE_EQ(find_reached(goals, "peak resident"), 600);
    // Half a hundredth of a second a ray in bounce 5, a fiftieth in bounce 1; shadow rays do not count.
    EXPECT_DOUBLE_EQ(find_reached(goals, "bounce 5"), 2.5);
    EXPECT_DOUBLE_EQ(find_reached(goals, "primary and shadow rays, frame"), 4);
    EXPECT_DOUBLE_EQ(find_reached(goals, "bark, direct against pre-tessellated"), 1.5);
    EXPECT_EQ(find_reached(goals, "party, direct against pre-tessellated"), -1);
    ASSERT_EQ(goals.size(), 5u);
    for (const Value& goal : goals)
        EXPECT_EQ(goal["met"].get<bool>(),
                  goal["name"].get<std::string>().find("frame") != std::string::npos && goal["unit"] == "ms")
            << goal["name"].get<std::string>();
}

TEST(Paper1, goals_of_a_device_are_none_of_the_cpu_engine) {
    Value result = make_result();
    result["device"]["engine"] = "cpu";
    const Value goals = make_paper1_goals(result);
    EXPECT_EQ(goals.size(), 3u);
    EXPECT_EQ(find_reached(goals, "frame"), -1);
}

TEST(Paper1, the_table_has_each_measure_once) {
    const std::string csv = write_csv(make_paper1_table(make_result()));
    for (const char* line :
         {"part,scene,variant,depth,kind,measure,unit,median,lowest,highest\n",
          "\ntable1_1,party,direct,,,total,bytes,1000,,\n",
          "\ntable1_1,bark,\"tessellated, level 5\",,,total,bytes,5000,,\n",
          "\ntable1_1,bark,\"paper, tessellated\",,,total,bytes,7000000000,,\n",
          "\nfigure1_7,bark,tessellated,,,frame,s,2,1,4\n", "\nfigure1_7,bark,tessellated,,,sort,s,1,0.5,2\n",
          "\nfigure1_10,bark,direct,5,bounce,total,s,0.5,0.25,1\n"}) {
        const size_t at = csv.find(line);
        EXPECT_NE(at, std::string::npos) << line;
        EXPECT_EQ(csv.find(line, at + 1), std::string::npos) << line;
    }
    EXPECT_EQ(csv.find("figure1_7,party,tessellated"), std::string::npos);
}

TEST(Paper1, bytes_and_variants_are_those_of_the_renders) {
    Paper1Options options;
    options.scenes = {"pumpkin"};
    options.settings.device.threads = 1;
    options.settings.surface.level = 2;
    options = make_quick_options(options);
    const Value result = run_paper1(options, [](const std::string&) {});
    const Scene scene = make_sample_scene("pumpkin", Instancing::none);
    RenderSettings settings = options.settings;
    settings.image.spp = 1, settings.image.bounces = 0;
    const Statistics expected = render(scene, settings).statistics;
    const Value& row = result["table1_1"][0];
    EXPECT_EQ(row["patches"], expected.patches);
    EXPECT_EQ(row["direct"]["total_bytes"], expected.geometry_bytes + expected.structures_bytes);
    ASSERT_EQ(row["tessellated_estimate"].size(), 3u); // the level of the run, and those of the paper
    settings.surface.level = 5;
    const TessellationCost cost = estimate_tessellation(scene, settings);
    EXPECT_EQ(row["tessellated_estimate"][1]["level"], "5");
    EXPECT_EQ(row["tessellated_estimate"][1]["total_bytes"], cost.geometry_bytes + cost.structures_bytes);

    const Value& variants = result["figure1_7"][0]["variants"];
    ASSERT_EQ(variants.size(), 3u);
    EXPECT_EQ(variants[0]["name"], "direct, no cache");
    EXPECT_EQ(variants[0]["bottom_cache_bytes"], 0);
    EXPECT_EQ(variants[0]["bottom_reused"], 0);
    EXPECT_EQ(variants[1]["bottom_built"], expected.bottom_built);
    EXPECT_GT(variants[1]["bottom_reused"], 0);
    EXPECT_GT(variants[0]["bottom_built"], variants[1]["bottom_built"].get<double>());
    EXPECT_EQ(variants[2]["bottom_built"], 0); // made up front
    EXPECT_GT(variants[2]["geometry_bytes"], variants[1]["geometry_bytes"].get<double>());
    const Value& casts = result["figure1_9"][0]["variants"][1]["casts"];
    ASSERT_EQ(casts.size(), 2u);
    EXPECT_EQ(casts[0]["rays"], expected.camera_rays);
    EXPECT_EQ(casts[1]["kind"], "shadow");
    EXPECT_EQ(casts[1]["rays"], expected.shadow_rays);
}

TEST(Paper1, knows_its_scenes) {
    for (const std::vector<std::string>& scenes :
         {std::vector<std::string>{}, std::vector<std::string>{"bark", "ear"}}) {
        Paper1Options options;
        options.scenes = scenes;
        try {
            run_paper1(options, [](const std::string&) {});
            FAIL() << "no error";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::usage);
        }
    }
}

} // namespace
} // namespace relief::bench
