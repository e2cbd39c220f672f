// bench characters without Blender, and with something that answers in its place.
#include <cstdlib>

#include <nlohmann/json.hpp>

#include "command.h"

namespace relief::cli {
namespace {

using nlohmann::json;

/// Renders with Relief in place of Blender, and prints the measures that the script prints.
constexpr const char* kMeasuredBlender = R"(#!/bin/sh
echo "$@" >> "$0.log"
while [ $# -gt 0 ]; do
    case "$1" in
    --probe) echo "relief: blender VERSION"; echo "relief: ANSWER"; exit 0 ;;
    --scene) scene=$2 ;;
    --size) size=$2 ;;
    --samples) samples=$2 ;;
    --bounces) bounces=$2 ;;
    --output) output=$2 ;;
    --session) session=1 ;;
    esac
    shift
done
test -n "$output" &&
    RELIEF render "$scene" -o "$output" --size $size --spp $samples --bounces $bounces --background transparent -q
echo "relief: measure render_s 8"
echo "relief: measure resident_peak_bytes 123456789"
test -n "$session" && printf "relief: measure %s_s 0.5\n" turned moved changed
exit 0
)";

class BenchCharacters : public CommandTest {
  protected:
    /// Options of a run on the plane with its map.
    std::vector<std::string> make_arguments(const std::vector<std::string>& more) const {
        std::vector<std::string> all = {"bench",    "characters", "--quick", "--mesh", "plane.obj", "--vdm",
                                        "bump.exr", "--space",    "tangent", "-q",     "-o",        "a"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }

    void write_blender(const std::string& name, const std::string& version, const std::string& answer) const {
        std::string text = kMeasuredBlender;
        const auto put = [&](const std::string& word, const std::string& value) {
            text.replace(text.find(word), word.size(), value);
        };
        put("VERSION", version), put("ANSWER", answer), put("RELIEF render", program_.string() + " render");
        write_program(name, text);
    }
    void write_program(const std::string& name, const std::string& text) const {
        write(name, text);
        std::filesystem::permissions(folder_ / name, std::filesystem::perms::owner_all);
    }

    CommandResult run_without_path(const std::vector<std::string>& arguments) {
        return finish(start(arguments, [] { setenv("PATH", "", 1); }));
    }

    json read_result() const { return json::parse(read("a/characters.json")); }
};

TEST_F(BenchCharacters, without_blender_measure_relief_and_name_what_is_skipped) {
    const CommandResult result =
        run_without_path({"bench", "characters", "--quick", "--scenes", "body", "-q", "-o", "a"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const json s = read_result();
    EXPECT_EQ(s["programs"], json({"Relief"}));
    ASSERT_EQ(s["skipped"].size(), 2u);
    EXPECT_EQ(s["skipped"][0]["name"], "Cycles");
    EXPECT_EQ(s["skipped"][1]["name"], "Relief in Blender");
    EXPECT_TRUE(contains(s["skipped"][0]["reason"], "PATH"));
    EXPECT_TRUE(s["goals"].empty());
    const json& relief = s["cases"][0]["programs"]["Relief"];
    for (const char* measure : {"first_sample_s", "first_sample_from_start_s", "render_s", "from_start_s",
                                "resident_peak_bytes", "first_s", "turned_s", "moved_s", "changed_s"})
        EXPECT_GT(relief[measure]["median"].get<double>(), 0) << measure;
    EXPECT_EQ(read("a/characters.csv").rfind("scene,width,height,program,to,measure,", 0), 0u);
    for (const char* chart : {"cold", "memory", "session"})
        EXPECT_TRUE(contains(read(std::string("a/characters_body_") + chart + ".svg"), "</svg>")) << chart;
}

TEST_F(BenchCharacters, compares_with_cycles_in_turn_and_writes_every_file) {
    write_blender("blender", "5.0.1", "with RELIEF");
    const CommandResult result = run(make_arguments({"--blender", "./blender", "--threads", "1"}));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const json s = read_result();
    EXPECT_EQ(s["programs"], json({"Relief", "Cycles 5.0.1", "Relief in Blender 5.0.1"}));
    EXPECT_TRUE(s["skipped"].empty());
    const json& entry = s["cases"][0];
    EXPECT_EQ(entry["scene"], "plane.obj");
    const json& cycles = entry["programs"]["Cycles 5.0.1"];
    EXPECT_EQ(cycles["first_sample_s"]["median"], 8.0);
    EXPECT_EQ(cycles["changed_s"]["median"], 0.5);
    EXPECT_EQ(cycles["resident_peak_bytes"]["median"], 123456789.0);
    EXPECT_LT(cycles["from_start_s"]["median"].get<double>(), 8.0) << "measured, not printed";
    ASSERT_EQ(entry["ratios"].size(), 2u);
    EXPECT_EQ(entry["ratios"][1]["program"], "Relief in Blender 5.0.1");
    EXPECT_EQ(entry["ratios"][1]["moved"]["median"], 1.0);
    EXPECT_EQ(entry["agreement"][0]["masks_differ"], 0);
    EXPECT_EQ(s["goals"].size(), 2u * 4);
    const std::string log = read("blender.log");
    for (const char* words : {"--engine CYCLES ", "--engine RELIEF ", "--samples 1 ", "--samples 2 ",
                              "--session --turn 15 --move ", "changed.exr", "--threads 1 "})
        EXPECT_TRUE(contains(log, words)) << words << log;
    EXPECT_TRUE(contains(read("a/characters_file0_session.svg"), "</svg>"));
}

TEST_F(BenchCharacters, the_newest_cycles_sets_the_goals_and_others_are_skipped_by_name) {
    write_blender("old", "4.5.15 LTS", "without RELIEF: No module named 'relief'");
    write_blender("new", "5.0.1", "without RELIEF: No module named 'relief'");
    write_program("broken", "#!/bin/sh\necho no bpy here\nexit 3\n");
    const CommandResult result =
        run(make_arguments({"--blender", "old", "--blender", "new", "--blender", "broken"}));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const json s = read_result();
    EXPECT_EQ(s["programs"], json({"Relief", "Cycles 5.0.1", "Cycles 4.5.15 LTS"}));
    ASSERT_EQ(s["skipped"].size(), 3u);
    EXPECT_TRUE(contains(s["skipped"][0]["name"], "broken"));
    EXPECT_TRUE(contains(s["skipped"][0]["reason"], "no bpy here"));
    EXPECT_EQ(s["skipped"][2]["name"], "Relief in Blender 4.5.15 LTS");
    EXPECT_EQ(s["skipped"][2]["reason"], "No module named 'relief'");
    for (const json& goal : s["goals"]) EXPECT_FALSE(contains(goal["name"], "4.5.15")) << goal;
}

TEST_F(BenchCharacters, a_program_that_prints_no_measure_ends_the_suite_with_its_command) {
    write_blender("blender", "5.0.1", "with RELIEF");
    std::string text = read("blender");
    text.replace(text.find("measure resident_peak_bytes"), 27, "nothing");
    write_program("blender", text);
    const CommandResult result = run(make_arguments({"--blender", "blender"}));
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(contains(result.errors, "resident_peak_bytes")) << result.errors;
    EXPECT_TRUE(contains(result.errors, "--engine CYCLES")) << result.errors;
    EXPECT_FALSE(exists("a/characters.json"));
}

TEST_F(BenchCharacters, wrong_options_have_messages) {
    const struct {
        std::vector<std::string> words;
        const char* message;
    } cases[] = {{{"--vdm", "bump.exr"}, "1 maps for 0 meshes"},
                 {{"--mesh", "plane.obj", "--space", "object"}, "--space needs a displacement map"},
                 {{"--mesh", "plane.obj", "--vdm", "bump.exr", "--space", "camera"}, "camera"},
                 {{"--mesh", "none.obj"}, "none.obj"},
                 {{"--blender", "nothing"}, "'nothing' is not a program"},
                 {{"--scenes", "bodi"}, "'bodi' is not one of"},
                 {{"--isa", "avx2"}, "--isa"}};
    for (const auto& [words, message] : cases) {
        std::vector<std::string> all = {"bench", "characters", "--quick", "-q"};
        all.insert(all.end(), words.begin(), words.end());
        const CommandResult result = run_without_path(all);
        EXPECT_NE(result.exit_code, 0) << message;
        EXPECT_TRUE(contains(result.errors, message)) << result.errors;
    }
    EXPECT_EQ(run({"bench", "cycles", "--vdm", "bump.exr"}).exit_code, 2);
}

} // namespace
} // namespace relief::cli
