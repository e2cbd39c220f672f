#include "bench/frame.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "bench/frame_runs.h"
#include "relief/error.h"

namespace relief::bench {
namespace {

FrameRun make_run(double prepare_s, double render_s, double processor_s) {
    return {{{"relief", {{"version", "0.1"}}},
             {"device", {{"engine", "cpu"}, {"threads", 2}}},
             {"time_s", {{"prepare", prepare_s}, {"render", render_s}, {"first_image", 0.5}}},
             {"stage_s", {{"shade", render_s}, {"film", 3 * render_s}}},
             {"rays", {{"total", 24}}},
             {"memory_bytes", {{"peak_resident", 1000}}}},
            processor_s};
}

Image make_picture(float red, float other) {
    Image image;
    image.width = 2, image.height = 1;
    image.channels = {"A", "R", "G", "B"};
    image.pixels = {1, red, other, other, 1, other, other, other};
    return image;
}

TEST(FrameRuns, samples_a_second_are_of_the_render_alone) {
    const Value told = describe_frame_runs({make_run(9, 2, 1), make_run(9, 4, 1), make_run(9, 5, 1)}, 100);
    EXPECT_EQ(told["samples_per_s"]["median"], 25.0);
    EXPECT_EQ(told["samples_per_s"]["highest"], 50.0);
    EXPECT_EQ(told["samples_per_s"]["lower_quartile"], 22.5);
    EXPECT_EQ(told["rays_per_sample"]["median"], 0.24);
    EXPECT_EQ(told["prepare_s"]["median"], 9.0);
    EXPECT_EQ(told["peak_resident_bytes"]["median"], 1000.0);
    EXPECT_EQ(told["version"], "0.1");
    EXPECT_EQ(told["device"]["threads"], 2);
}

TEST(FrameRuns, shares_of_stages_add_up) {
    const Value stages =
        describe_frame_runs({make_run(1, 2, 1), make_run(1, 4, 1), make_run(1, 6, 1)}, 1)["stages"];
    EXPECT_EQ(stages["shade"]["seconds"]["median"], 4.0);
    EXPECT_EQ(stages["shade"]["share"], 0.25);
    EXPECT_EQ(stages["film"]["share"], 0.75);
}

TEST(FrameRuns, what_statistics_lack_is_null) {
    FrameRun old{{{"time_s", {{"render", 2.0}}}, {"stage_s", {{"shade", 1.0}, {"sort", "none"}}}}, 3};
    const Value told = describe_frame_runs({old}, 8);
    EXPECT_EQ(told["samples_per_s"]["median"], 4.0);
    for (const char* name :
         {"version", "device", "rays_per_sample", "prepare_s", "first_image_s", "peak_resident_bytes"})
        EXPECT_EQ(told[name].kind(), Value::Kind::nothing) << name;
    EXPECT_EQ(told["stages"].size(), 1u);
    EXPECT_EQ(told["stages"]["shade"]["share"], 1.0);
    const Value compared = compare_frame_runs({make_run(1, 1, 1)}, {old});
    EXPECT_EQ(compared["ratio"]["median"], 2.0);
    EXPECT_EQ(compared["ratio_with_preparation"].kind(), Value::Kind::nothing);
    old.statistics = Value{{"time_s", {{"render", 2.0}}}};
    EXPECT_TRUE(describe_frame_runs({old}, 8)["stages"].empty());
}

/// One run that lacks a figure must not leave a median of the others.
TEST(FrameRuns, what_one_run_lacks_is_null) {
    FrameRun other = make_run(1, 2, 1);
    other.statistics["time_s"]["prepare"] = Value();
    const Value told = describe_frame_runs({make_run(1, 2, 1), other}, 8);
    EXPECT_EQ(told["prepare_s"].kind(), Value::Kind::nothing);
    EXPECT_EQ(told["render_s"]["median"], 2.0);
}

TEST(FrameRuns, the_ratio_is_the_median_of_pairs) {
    // The machine is three times slower in the second pair: the ratio of medians would be another.
    const std::vector<FrameRun> own = {make_run(1, 1, 2), make_run(3, 3, 2), make_run(1, 1, 2)};
    const std::vector<FrameRun> baseline = {make_run(3, 2, 2), make_run(9, 6, 4), make_run(3, 4, 6)};
    const Value compared = compare_frame_runs(own, baseline);
    EXPECT_EQ(compared["ratio"]["median"], 2.0);
    EXPECT_EQ(compared["ratio"]["highest"], 4.0);
    EXPECT_EQ(compared["ratio_with_preparation"]["median"], 2.5);
    EXPECT_EQ(compared["ratio_by_processor"]["median"], 2.0);
}

TEST(FrameRuns, pictures_differ_by_brightness_and_by_error) {
    const Value same = compare_frame_pictures(make_picture(2, 1), make_picture(2, 1));
    EXPECT_EQ(same["brightness_difference"], 0.0);
    EXPECT_EQ(same["relative_squared_error"], 0.0);
    const Value brighter = compare_frame_pictures(make_picture(3, 1), make_picture(1, 1));
    EXPECT_NEAR(brighter["brightness_difference"].get<double>(), 2.0 / 6, 1e-12);
    EXPECT_NEAR(brighter["relative_squared_error"].get<double>(), 4 / 1.01 / 6, 1e-12);
    EXPECT_LT(compare_frame_pictures(make_picture(0, 1), make_picture(1, 1))["brightness_difference"], 0.0);
    EXPECT_EQ(compare_frame_pictures(make_picture(1, 1), make_picture(0, 0))["brightness_difference"].kind(),
              Value::Kind::nothing);
    Image small = make_picture(1, 1);
    small.width = 1, small.pixels.resize(4);
    EXPECT_THROW(compare_frame_pictures(small, make_picture(1, 1)), Error);
}

class FrameTables : public testing::Test {
  protected:
    /// The baseline has a stage of its own, and neither `film` nor a time of preparation.
    FrameTables() {
        FrameRun old{{{"time_s", {{"render", 4.0}}}, {"stage_s", {{"shade", 3.0}, {"bake", 1.0}}}}, 8};
        const std::vector<FrameRun> own = {make_run(1, 2, 4)}, baseline = {old};
        Value entry = {{"scene", "bark"}, {"isa", "avx2"}, {"relief", describe_frame_runs(own, 8e6)}};
        entry["noise"] = compare_frame_pictures(make_picture(3, 1), make_picture(1, 1));
        alone_ = {{"cases", Value::list({entry})}};
        entry["baseline"] = describe_frame_runs(baseline, 8e6);
        entry.update(compare_frame_runs(own, baseline));
        entry["picture"] = compare_frame_pictures(make_picture(1, 1), make_picture(1, 1));
        both_ = {{"baseline", "old/relief"}, {"cases", Value::list({entry})}};
    }

    Value alone_, both_;
};

TEST_F(FrameTables, page_has_a_dash_for_what_a_program_does_not_tell) {
    const std::string page = make_frame_page(both_);
    EXPECT_NE(
        page.find(
            "| bark | avx2 | 4 (4 to 4) | 2 (2 to 2) | 2 (2 to 2) | - | 2 (2 to 2) | 3e-06 | - | 1 | - | "
            "+0.000 %, 0 | +33.333 %, 0.66 |"),
        std::string::npos)
        << page;
    EXPECT_NE(page.find("| scene | isa | program | shade | film | bake |"), std::string::npos) << page;
    EXPECT_NE(page.find("| bark | avx2 | relief | 25.0 % (2 s) | 75.0 % (6 s) | - |"), std::string::npos)
        << page;
    EXPECT_NE(page.find("| bark | avx2 | baseline | 75.0 % (3 s) | - | 25.0 % (1 s) |"), std::string::npos)
        << page;
}

TEST_F(FrameTables, page_of_one_program_has_no_ratio) {
    const std::string page = make_frame_page(alone_);
    EXPECT_NE(page.find("| bark | avx2 | 4 (4 to 4) | 3e-06 | 1 |\n"), std::string::npos) << page;
    EXPECT_EQ(page.find("ratio"), std::string::npos) << page;
    EXPECT_EQ(page.find("baseline"), std::string::npos) << page;
}

TEST_F(FrameTables, table_leaves_cells_empty_where_nothing_is_told) {
    const std::string csv = write_csv(make_frame_table(both_));
    for (const char* row :
         {"\nbark,avx2,relief,samples_per_s,4000000,4000000,4000000,4000000,4000000\n",
          "\nbark,avx2,baseline,prepare_s,,,,,\n", "\nbark,avx2,baseline,bake_share,0.25,,,,\n",
          "\nbark,avx2,,ratio,2,2,2,2,2\n", "\nbark,avx2,,ratio_with_preparation,,,,,\n",
          "\nbark,avx2,,picture_relative_squared_error,0,,,,\n"})
        EXPECT_NE(csv.find(row), std::string::npos) << row << csv;
    EXPECT_EQ(csv.find("baseline,film"), std::string::npos) << csv;
    EXPECT_EQ(write_csv(make_frame_table(alone_)).find("ratio"), std::string::npos);
}

/// A shell script in the place of the command.
class FramePrograms : public testing::Test {
  protected:
    void SetUp() override {
        std::string pattern = (std::filesystem::temp_directory_path() / "relief-frame-XXXXXX").string();
        ASSERT_NE(mkdtemp(pattern.data()), nullptr);
        folder_ = pattern;
    }
    void TearDown() override {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    FrameProgram make_program(const std::string& text, EngineKind engine = EngineKind::cpu) {
        std::ofstream(folder_ / "program") << "#!/bin/sh\n" + text + "\n";
        std::filesystem::permissions(folder_ / "program", std::filesystem::perms::owner_all);
        RenderSettings settings;
        settings.image.width = 8, settings.image.height = 4, settings.image.spp = 3,
        settings.image.bounces = 4;
        settings.device.threads = 2, settings.device.engine = engine;
        return {folder_ / "program", folder_ / "own", settings};
    }
    FrameTask make_task() const {
        return {.scene = folder_ / "scene.json", .picture = folder_ / "a.exr", .isa = "avx2", .seed = 7};
    }
    /// Of the error of a render.
    Error render_and_fail(const FrameProgram& program) {
        try {
            program.render(make_task());
        } catch (const Error& error) {
            return error;
        }
        ADD_FAILURE() << "no error";
        return Error(ErrorKind::failed, {});
    }
    std::filesystem::path folder_;
};

/// Writes what it was given to the picture.
constexpr const char* kWrite = R"(echo "$@ cache=$XDG_CACHE_HOME" > "FOLDER/a.exr"
echo '{"time_s": {"render": 2}}' > FOLDER/own/statistics.json)";

std::string place(std::string text, const std::string& folder) {
    for (size_t at; (at = text.find("FOLDER")) != std::string::npos;) text.replace(at, 6, folder);
    return text;
}

TEST_F(FramePrograms, pass_only_options_that_old_commands_know) {
    const std::string folder = folder_.string();
    const auto read_words = [&] {
        std::ifstream stream(folder_ / "a.exr");
        std::string line;
        std::getline(stream, line);
        return line;
    };
    const FrameRun run = make_program(place(kWrite, folder)).render(make_task());
    EXPECT_EQ(run.statistics["time_s"]["render"], 2.0);
    EXPECT_NE(
        read_words().find(place(
            "render FOLDER/scene.json -q --engine cpu --isa avx2 --size 8x4 --spp 3 --bounces 4 "
            "--threads 2 --clamp-indirect 1e9 --seed 7 -o FOLDER/a.exr --stats FOLDER/own/statistics.json",
            folder)),
        std::string::npos)
        << read_words();
    make_program(place(kWrite, folder), EngineKind::vulkan).render(make_task());
    EXPECT_NE(read_words().find("--engine vulkan --size"), std::string::npos) << read_words();
    EXPECT_NE(read_words().find("cache=" + folder + "/own/cache"), std::string::npos) << read_words();
}

TEST_F(FramePrograms, failures_name_the_command) {
    const Error failed = render_and_fail(make_program("echo no such option >&2; exit 2"));
    EXPECT_EQ(failed.kind(), ErrorKind::failed);
    EXPECT_EQ(failed.message(), "ended with exit code 2:\nno such option");
    EXPECT_NE(failed.where().find("/program render "), std::string::npos) << failed.where();
    EXPECT_NE(failed.where().find(" --spp 3 "), std::string::npos) << failed.where();
    const Error no_scene = [&] {
        try {
            make_program("exit 0").write_scene("bark", folder_ / "bark");
        } catch (const Error& error) {
            return error;
        }
        return Error(ErrorKind::failed, {});
    }();
    EXPECT_NE(no_scene.where().find("/program scene bark -o "), std::string::npos) << no_scene.where();
}

TEST_F(FramePrograms, files_of_an_earlier_run_do_not_count) {
    make_program(place(kWrite, folder_.string())).render(make_task());
    EXPECT_NE(render_and_fail(make_program("exit 0")).message().find("did not write"), std::string::npos);
}

TEST_F(FramePrograms, statistics_without_the_time_of_the_render_are_refused) {
    std::string text = place(kWrite, folder_.string());
    text.replace(text.find("render\": 2"), 6, "others");
    EXPECT_NE(render_and_fail(make_program(text)).message().find("time_s.render"), std::string::npos);
}

TEST_F(FramePrograms, must_be_executable_files) {
    for (const std::filesystem::path& program :
         {folder_, folder_ / "nothing", std::filesystem::path("/etc/passwd")})
        EXPECT_THROW(FrameProgram(program, folder_ / "own", {}), Error) << program;
}

} // namespace
} // namespace relief::bench
