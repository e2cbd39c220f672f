// bench frame: this command alone, beside itself, and beside programs that are not quite it.
#include <algorithm>
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "command.h"

namespace relief::cli {
namespace {

using nlohmann::json;

class BenchFrame : public CommandTest {
  protected:
    /// A shell script; "RELIEF" in it is the built command.
    std::string make_program(std::string text) {
        const std::string name = "RELIEF";
        for (size_t at; (at = text.find(name)) != std::string::npos;)
            text.replace(at, name.size(), RELIEF_BINARY);
        write("old", "#!/bin/sh\n" + text + "\n");
        std::filesystem::permissions(folder_ / "old", std::filesystem::perms::owner_all);
        return (folder_ / "old").string();
    }
    CommandResult measure(const std::vector<std::string>& more) {
        std::vector<std::string> words = {"bench", "frame", "--quick", "--scenes", "bark", "-q"};
        words.insert(words.end(), more.begin(), more.end());
        return run(words);
    }
};

/// Renders, and takes from the statistics what an older command did not tell.
constexpr const char* kOlder = R"("RELIEF" "$@" || exit $?
while [ $# -gt 1 ]; do
    case "$1" in --stats) sed -i -e 's/"shade"/"colours"/' -e '/"prepare"/d' "$2" ;; esac
    shift
done)";

TEST_F(BenchFrame, beside_itself_it_renders_the_same_picture) {
    const CommandResult result = measure({"--baseline", RELIEF_BINARY, "--isa", "best", "--threads", "1"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.errors, "");
    const json s = json::parse(read("frame/frame.json"));
    for (const char* key : {"/build/commit", "/machine/processor", "/load_average/one_minute",
                            "/comparable/0", "/cases/0/relief/samples_per_s/upper_quartile",
                            "/cases/0/relief/stages/shade/share", "/cases/0/baseline/processor_s/median",
                            "/cases/0/ratio_by_processor/lower_quartile", "/goals/0/met"})
        EXPECT_TRUE(s.contains(json::json_pointer(key))) << key;
    EXPECT_EQ(s["settings"]["bounces"], 4);
    EXPECT_EQ(s["settings"]["threads"], 1);
    ASSERT_EQ(s["cases"].size(), 1u);
    const json& entry = s["cases"][0];
    EXPECT_EQ(entry["isa"], "best");
    EXPECT_EQ(entry["relief"]["device"]["threads"], 1);
    const double samples = 64 * 36 * 2;
    EXPECT_NEAR(entry["relief"]["samples_per_s"]["median"].get<double>(),
                samples / entry["relief"]["render_s"]["median"].get<double>(), 1e-6 * samples);
    EXPECT_EQ(entry["picture"]["brightness_difference"], 0.0);
    EXPECT_EQ(entry["picture"]["relative_squared_error"], 0.0);
    EXPECT_GT(entry["noise"]["relative_squared_error"].get<double>(), 0);
    EXPECT_EQ(s["goals"][0]["reached"], entry["ratio"]["median"]);
    EXPECT_EQ(read("frame/frame.csv").rfind("scene,isa,program,measure,", 0), 0u);
    EXPECT_NE(read("frame/frame.md").find("| bark | best | baseline | "), std::string::npos);
    for (const char* chart : {"frame/frame_speed.svg", "frame/frame_stages.svg"})
        EXPECT_NE(read(chart).find("</svg>"), std::string::npos) << chart;
}

TEST_F(BenchFrame, alone_it_has_neither_ratio_nor_goals) {
    const CommandResult result = measure({"-o", "alone"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const json s = json::parse(read("alone/frame.json"));
    EXPECT_FALSE(s.contains("baseline"));
    EXPECT_TRUE(s["goals"].empty());
    ASSERT_FALSE(s["cases"].empty());
    EXPECT_EQ(s["cases"].size(), s["settings"]["isas"].size());
    for (const json& entry : s["cases"]) {
        EXPECT_FALSE(entry.contains("ratio"));
        EXPECT_GT(entry["relief"]["samples_per_s"]["median"].get<double>(), 0);
        EXPECT_GT(entry["noise"]["relative_squared_error"].get<double>(), 0);
        if (entry["isa"] != "best") EXPECT_EQ(entry["relief"]["device"]["isa"], entry["isa"]);
    }
    EXPECT_NE(read("alone/frame_speed.svg").find("</svg>"), std::string::npos);
}

TEST_F(BenchFrame, what_an_older_command_does_not_tell_is_a_dash) {
    const CommandResult result = measure({"--baseline", make_program(kOlder), "--isa", "best"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const json entry = json::parse(read("frame/frame.json"))["cases"][0];
    EXPECT_TRUE(entry["baseline"]["prepare_s"].is_null());
    EXPECT_TRUE(entry["ratio_with_preparation"].is_null());
    EXPECT_GT(entry["ratio"]["median"].get<double>(), 0);
    EXPECT_TRUE(entry["baseline"]["stages"].contains("colours"));
    EXPECT_FALSE(entry["baseline"]["stages"].contains("shade"));
    const std::string page = read("frame/frame.md");
    const size_t row = page.find("| bark | best | baseline | ");
    ASSERT_NE(row, std::string::npos) << page;
    EXPECT_NE(page.substr(row).find("| - |"), std::string::npos) << page;
    EXPECT_EQ(read("frame/frame_stages.svg").find("not told"), std::string::npos);
}

TEST_F(BenchFrame, a_baseline_that_fails_is_named_with_its_command) {
    const std::string old = make_program(R"(test "$1" = scene && exec "RELIEF" "$@"
echo "old: unknown option" >&2
exit 2)");
    const CommandResult failed = measure({"--baseline", old, "--isa", "best"});
    EXPECT_EQ(failed.exit_code, 1);
    EXPECT_NE(failed.errors.find(old + " render frame/scenes/bark/scene.json"), std::string::npos)
        << failed.errors;
    EXPECT_NE(failed.errors.find("exit code 2:\nold: unknown option"), std::string::npos) << failed.errors;
    EXPECT_FALSE(exists("frame/frame.json"));
    const CommandResult none = measure({"--baseline", "nowhere/relief"});
    EXPECT_EQ(none.exit_code, 2);
    EXPECT_NE(none.errors.find("nowhere/relief"), std::string::npos) << none.errors;
}

TEST_F(BenchFrame, options_that_it_has_not_are_refused) {
    for (const std::vector<std::string>& words : {std::vector<std::string>{"--mesh", "plane.obj"},
                                                  {"--level", "3"},
                                                  {"--levels", "3"},
                                                  {"--spp", "0"},
                                                  {"--engine", "vulkan", "--isa", "avx2"},
                                                  {"--engine", "vulkan", "--bottom", "split"}})
        EXPECT_EQ(measure(words).exit_code, 2) << words[0];
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"bench", "frame", "--scenes", "rocks"},
          {"bench", "edits", "--baseline", "old"},
          {"bench", "quality", "--spp", "4"}})
        EXPECT_EQ(run(words).exit_code, 2) << words[1];
}

} // namespace
} // namespace relief::cli
