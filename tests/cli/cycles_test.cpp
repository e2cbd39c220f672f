// bench cycles and quality without Blender, and with something that answers in its place.
#include <cstdlib>

#include <nlohmann/json.hpp>

#include "command.h"

namespace relief::cli {
namespace {

using nlohmann::json;

/// Renders with Relief in place of Cycles, and prints what Blender prints.
constexpr const char* kBlender =
    R"(#!/bin/sh
while [ $# -gt 1 ]; do
    case "$1" in
    --scene) scene=$2 ;;
    --size) size=$2 ;;
    --samples) samples=$2 ;;
    --bounces) bounces=$2 ;;
    --output) output=$2 ;;
    --seed) seed=$2 ;;
    esac
    shift
done
test -n "$output" && )" RELIEF_BINARY
    R"( render "$scene" -o "$output" --size $size --spp $samples --bounces $bounces --seed $seed --background transparent -q
echo "relief: blender 3.4.1"
echo "relief: render starts"
echo "Fra:1 Mem:9M (Peak 9M) | Time:00:00.00 | Mem:0.00M, Peak:7.50M | Scene, ViewLayer | Sample 0/$samples"
echo "Fra:1 Mem:9M (Peak 9M) | Time:00:00.01 | Mem:0.00M, Peak:8.25M | Scene, ViewLayer | Sample 1/$samples"
echo "relief: render ends"
echo "relief: peak resident 123456789"
)";

class BenchCycles : public CommandTest {
  protected:
    /// With `text` as the program `blender`, before all others in PATH.
    CommandResult run_with(const std::string& text, const std::vector<std::string>& arguments) {
        std::filesystem::create_directories(folder_ / "bin");
        write("bin/blender", text);
        std::filesystem::permissions(folder_ / "bin/blender", std::filesystem::perms::owner_all);
        const std::string path = (folder_ / "bin").string() + ":/usr/bin:/bin";
        return finish(start(arguments, [&] { setenv("PATH", path.c_str(), 1); }));
    }
};

TEST_F(BenchCycles, without_blender_it_says_how_to_get_it) {
    const CommandResult result = finish(start({"bench", "cycles", "--quick"}, [] { setenv("PATH", "", 1); }));
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.errors.find("apt-get install"), std::string::npos) << result.errors;
    EXPECT_FALSE(exists("cycles/cycles.json"));
}

TEST_F(BenchCycles, measures_both_and_writes_every_file) {
    const CommandResult result = run_with(
        kBlender, {"bench", "cycles", "--quick", "--scenes", "rock", "--threads", "1", "-q", "-o", "a"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const json s = json::parse(read("a/cycles.json"));
    for (const char* key :
         {"/build/commit", "/machine/processor", "/device/isa", "/settings/runs", "/comparable/0",
          "/scenes/0/cases/3/relief/render_s/median", "/scenes/0/cases/0/cycles/images_s/lowest",
          "/scenes/0/cases/4/importance_map", "/goals/2/unit"})
        EXPECT_TRUE(s.contains(json::json_pointer(key))) << key;
    EXPECT_EQ(s["blender"], "3.4.1");
    EXPECT_EQ(s["settings"]["threads"], 1);
    EXPECT_EQ(s["scenes"][0]["agreement"]["masks_differ"], 0);
    EXPECT_EQ(s["scenes"][0]["agreement"]["brightness_ratio"], 1.0);
    EXPECT_EQ(s["scenes"][0]["cases"][0]["cycles"]["resident_peak_bytes"]["median"], 123456789.0);
    EXPECT_EQ(s["scenes"][0]["cases"][0]["cycles"]["cycles_own_peak_bytes"]["median"], 8.25 * (1 << 20));
    EXPECT_EQ(s["goals"].size(), 3u);
    EXPECT_EQ(read("a/cycles.csv").rfind("scene,samples,bounces,", 0), 0u);
    for (const char* chart : {"a/cycles_rock.svg", "a/cycles_memory.svg"})
        EXPECT_NE(read(chart).find("</svg>"), std::string::npos) << chart;
}

TEST_F(BenchCycles, reports_nothing_when_blender_fails_or_shows_something_else) {
    const std::vector<std::string> arguments = {"bench", "cycles", "--quick", "--scenes", "rock", "-q"};
    const CommandResult failed = run_with("#!/bin/sh\necho 'Error: no engine'\nexit 3\n", arguments);
    EXPECT_EQ(failed.exit_code, 1);
    EXPECT_NE(failed.errors.find("no engine"), std::string::npos) << failed.errors;
    std::string other = kBlender;
    other.replace(other.find("scene=$2"), 8, "scene=" + (folder_ / "plane.obj").string());
    const CommandResult different = run_with(other, arguments);
    EXPECT_EQ(different.exit_code, 1);
    EXPECT_NE(different.errors.find("masks_differ"), std::string::npos) << different.errors;
    EXPECT_FALSE(exists("cycles/cycles.json"));
}

/// Blender as a module of `python3`, which is asked for it first.
TEST_F(BenchCycles, takes_the_python_module_too) {
    std::string python = kBlender;
    python.insert(10, "test \"$1\" = -c && exit 0\n");
    std::filesystem::create_directories(folder_ / "bin");
    write("bin/python3", python);
    std::filesystem::permissions(folder_ / "bin/python3", std::filesystem::perms::owner_all);
    const std::string path = (folder_ / "bin").string() + ":/bin";
    const CommandResult result = finish(start({"bench", "cycles", "--quick", "--scenes", "rock", "-q"},
                                              [&] { setenv("PATH", path.c_str(), 1); }));
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(json::parse(read("cycles/cycles.json"))["blender"], "3.4.1");
}

TEST_F(BenchCycles, quality_finds_less_error_in_more_samples_and_the_time_to_the_same_error) {
    const CommandResult result = run_with(
        kBlender, {"bench", "quality", "--quick", "--scenes", "rock", "--threads", "1", "-q", "-o", "q"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const json s = json::parse(read("q/quality.json"));
    const json& scene = s["scenes"][0];
    EXPECT_EQ(scene["series"].size(), scene.contains("denoised_relief") ? 3u : 4u);
    EXPECT_EQ(s["goals"].size(), scene.contains("denoised_relief") ? 1u : 2u);
    const json &cycles = scene["series"][0]["points"], &relief = scene["series"][1]["points"];
    ASSERT_EQ(cycles.size(), 2u);
    ASSERT_EQ(relief.size(), 3u);
    for (size_t k = 1; k < relief.size(); ++k)
        EXPECT_LT(relief[k]["error"].get<double>(), 0.5 * relief[k - 1]["error"].get<double>()) << k;
    // Both are Relief here: the same pictures, so the same error after the same samples.
    EXPECT_EQ(cycles[1]["error"], relief[1]["error"]);
    EXPECT_DOUBLE_EQ(scene["same_error"][1]["relief_s"], relief[1]["seconds"]);
    EXPECT_EQ(read("q/quality.csv").rfind("scene,program,denoised,samples,seconds,error", 0), 0u);
    EXPECT_NE(read("q/quality_rock.svg").find("</svg>"), std::string::npos);
}

TEST_F(BenchCycles, options_that_it_has_not_are_refused) {
    for (const std::vector<std::string>& words : {std::vector<std::string>{"--mesh", "plane.obj"},
                                                  {"--isa", "avx2"},
                                                  {"--level", "3"},
                                                  {"--scenes", "bark"}}) {
        std::vector<std::string> all = {"bench", "cycles"};
        all.insert(all.end(), words.begin(), words.end());
        EXPECT_EQ(run_with(kBlender, all).exit_code, 2) << words[0];
    }
}

} // namespace
} // namespace relief::cli
