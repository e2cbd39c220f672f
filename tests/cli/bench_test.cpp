// What the suites of measurements write.
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "command.h"

namespace relief::cli {
namespace {

using nlohmann::json;

class Bench : public CommandTest {
  protected:
    bool is_chart(const std::string& name) const { return read(name).find("</svg>") != std::string::npos; }
};

TEST_F(Bench, paper1_writes_the_table_and_every_figure) {
    const CommandResult result = run({"bench", "paper1", "--quick", "--scenes", "bark", "-o", "a/b"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const json s = json::parse(read("a/b/paper1.json"));
    for (const char* key :
         {"/build/commit", "/machine/processor", "/device/engine", "/settings/runs", "/comparable/0",
          "/paper_says/0/text", "/table1_1/0/direct/bytes_a_patch",
          "/table1_1/0/tessellated_estimate/2/total_bytes", "/table1_1/0/paper/direct_bytes",
          "/figure1_7/0/variants/2/stage_s/bottom_build/median", "/figure1_7/0/variants/2/frame_s/highest",
          "/figure1_9/0/variants/1/casts/1/stage_s/sort", "/figure1_10/0/variants/0/casts/2/total_s/median",
          "/goals/0/name", "/goals/0/goal", "/goals/0/reached", "/goals/0/unit", "/goals/0/met"})
        EXPECT_TRUE(s.contains(json::json_pointer(key))) << key;
    EXPECT_EQ(s["suite"], "paper1");
    EXPECT_EQ(s["table1_1"][0]["patches"], 3120 + 5) << "five quads are concave and are cut in two";
    for (const json& variant : s["figure1_7"][0]["variants"]) EXPECT_EQ(variant["outcome"], "measured");
    EXPECT_EQ(read("a/b/paper1.csv").rfind("part,scene,variant,", 0), 0u);
    for (const char* chart : {"table1", "figure1_7", "figure1_9", "figure1_10"})
        EXPECT_TRUE(is_chart(std::string("a/b/paper1_") + chart + ".svg")) << chart;
}

TEST_F(Bench, a_pre_tessellated_scene_above_the_limit_is_shown_with_its_bytes) {
    const CommandResult result =
        run({"bench", "--quick", "--scenes", "pumpkin", "--tessellated-limit", "0", "-q"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.errors, "");
    const json variant = json::parse(read("paper1/paper1.json"))["figure1_7"][0]["variants"][2];
    EXPECT_EQ(variant["outcome"], "refused");
    EXPECT_NE(variant["reason"].get<std::string>().find("bytes"), std::string::npos);
    EXPECT_NE(read("paper1/paper1_figure1_7.svg").find("not made"), std::string::npos);
}

TEST_F(Bench, paper2_measures_a_mesh_of_the_user) {
    write("plate.obj",
          "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n");
    const CommandResult result =
        run({"bench", "paper2", "--quick", "--scenes", "body", "--mesh", "plate.obj", "-q", "-o", "p2"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.errors, "");
    const json s = json::parse(read("p2/paper2.json"));
    for (const char* key :
         {"/build/commit", "/machine/processor", "/settings/runs", "/comparable/0", "/paper_says/0/text",
          "/paper_models/2/bytes_a_triangle", "/meshes/0/builds/4/used_share",
          "/meshes/0/builds/0/seconds/median", "/meshes/0/casts/0/seconds/lowest",
          "/meshes/0/casts/0/restarts_a_ray", "/goals/0/reached"})
        EXPECT_TRUE(s.contains(json::json_pointer(key))) << key;
    EXPECT_EQ(s["meshes"][1]["mesh"], "plate.obj");
    EXPECT_EQ(s["meshes"][1]["triangles"], 4);
    EXPECT_EQ(read("p2/paper2.csv").rfind("mesh,part,tree,", 0), 0u);
    for (const char* chart : {"builds", "bytes", "body_primary", "body_diffuse", "mesh1_shadow"})
        EXPECT_TRUE(is_chart(std::string("p2/paper2_") + chart + ".svg")) << chart;
}

TEST_F(Bench, paper3_measures_the_four_pairs) {
    const CommandResult result = run({"bench", "paper3", "--quick", "--scenes", "body", "-q"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const json s = json::parse(read("paper3/paper3.json"));
    EXPECT_EQ(s["scenes"][0]["ways"].size(), 4u);
    EXPECT_EQ(s["goals"][0]["reached"], 0);
    for (const char* key : {"/device/engine", "/comparable/0", "/paper_says/0/text",
                            "/scenes/0/ways/3/frame_s/median", "/scenes/0/ways/3/structures_bytes"})
        EXPECT_TRUE(s.contains(json::json_pointer(key))) << key;
    for (const char* chart : {"bytes", "body"})
        EXPECT_TRUE(is_chart(std::string("paper3/paper3_") + chart + ".svg")) << chart;
}

TEST_F(Bench, options_of_other_suites_are_refused) {
    for (const std::vector<std::string>& words : {std::vector<std::string>{"paper2", "--level", "3"},
                                                  {"paper3", "--structure", "lbvh"},
                                                  {"paper2", "--scenes", "bark"},
                                                  {"paper1", "--mesh", "a.obj"},
#ifdef RELIEF_EMBREE
                                                  {"triangles", "--threads", "2"},
                                                  {"peers", "--mesh", "a.obj"},
                                                  {"peers", "--engine", "vulkan"},
                                                  {"peers", "--scenes", "barks"},
#endif
                                                  {"paper1", "--levels", "3"},
                                                  {"paper3", "--tessellated-limit", "7"}}) {
        std::vector<std::string> all = {"bench", "--quick"};
        all.insert(all.end(), words.begin(), words.end());
        EXPECT_EQ(run(all).exit_code, 2) << words[1];
    }
}

TEST_F(Bench, edits_measures_pictures_after_edits_beside_fresh_loads) {
    const CommandResult result = run({"bench", "edits", "--quick", "-q"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const json s = json::parse(read("edits/edits.json"));
    ASSERT_EQ(s["pictures"].size(), 2u);
    for (const json& picture : s["pictures"]) {
        EXPECT_EQ(picture["edits"]["picture_s"]["runs"], 16);
        EXPECT_GT(picture["fresh"]["load_s"]["median"].get<double>(), 0);
        // An edit on the far side leaves nearly all of the picture as it was.
        EXPECT_LT(picture["edits"]["rays_share"]["lowest"].get<double>(), 0.9);
        EXPECT_GT(picture["edits"]["rays_share"]["highest"].get<double>(), 0);
        EXPECT_GT(picture["ratio"].get<double>(), 0);
    }
    const std::string csv = read("edits/edits.csv");
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
    EXPECT_NE(read("edits/pumpkin/scene.json").find("pumpkin"), std::string::npos);
}

#ifdef RELIEF_EMBREE
TEST_F(Bench, triangles_compares_hits_and_times_with_embree) {
    const CommandResult result = run({"bench", "triangles", "--quick", "-q"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const json s = json::parse(read("triangles/triangles.json"));
    ASSERT_EQ(s["meshes"].size(), 2u);
    for (const json& mesh : s["meshes"]) {
        EXPECT_GT(mesh["build"]["ratio"].get<double>(), 0);
        EXPECT_GT(mesh["casts"][0]["hits"].get<size_t>(), mesh["casts"][0]["count"].get<size_t>() / 5);
        for (const json& cast : mesh["casts"]) {
            EXPECT_GT(cast["count"].get<size_t>(), 0u);
            EXPECT_LE(cast["differences_from_embree_robust"].get<size_t>(),
                      cast["count"].get<size_t>() / 200);
            EXPECT_EQ(cast["differences_of_packets"], 0);
        }
    }
    EXPECT_EQ(s["goals"].size(), 6u);
    EXPECT_EQ(read("triangles/triangles.csv").rfind("mesh,triangles,part,", 0), 0u);
}

TEST_F(Bench, peers_writes_first_images_rays_and_goals) {
    const CommandResult result = run({"bench", "peers", "--quick", "--scenes", "rock", "-q"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.errors, "");
    const json s = json::parse(read("peers/peers.json"));
    for (const char* key :
         {"/build/commit", "/machine/processor", "/settings/threads", "/embree_version", "/scenes/1/level",
          "/scenes/0/memory/bytes_a_patch", "/scenes/0/memory/embree/grid/bytes_a_micro_quad",
          "/scenes/0/agreement/0/at_edges", "/scenes/0/casts/0/ways/0/rays_per_s",
          "/scenes/0/casts/8/ways/3/seconds/lowest", "/scenes/0/cold/relief/first_diffuse_s/median",
          "/scenes/0/cold/subdivision/build_s/highest", "/scenes/0/bounces/0/seconds_a_ray",
          "/goals/0/ratio"})
        EXPECT_TRUE(s.contains(json::json_pointer(key))) << key;
    EXPECT_EQ(read("peers/peers.csv").rfind("scene,level,part,", 0), 0u);
    for (const char* chart : {"rock_cold", "rock_3_rays", "rock_auto_rays"})
        EXPECT_TRUE(is_chart(std::string("peers/peers_") + chart + ".svg")) << chart;
}

TEST_F(Bench, peers_measures_a_scene_of_the_user) {
    ASSERT_EQ(run({"scene", "rock", "-o", "rock"}).exit_code, 0);
    const CommandResult result =
        run({"bench", "peers", "--quick", "--scene", "rock/scene.json", "--levels", "2", "-q"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const json s = json::parse(read("peers/peers.json"));
    ASSERT_EQ(s["scenes"].size(), 1u);
    EXPECT_EQ(s["scenes"][0]["scene"], "rock/scene.json");
    EXPECT_EQ(s["scenes"][0]["level"], "2");
    EXPECT_TRUE(is_chart("peers/peers_scene0_2_rays.svg"));
}
#endif

TEST_F(Bench, is_refused_with_its_target_where_its_program_is_missing) {
    std::filesystem::copy_file(program_, folder_ / "relief");
    program_ = folder_ / "relief";
    const CommandResult result = run({"bench", "paper2", "--quick"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.errors.find((folder_ / "relief-bench").string()), std::string::npos) << result.errors;
    EXPECT_NE(result.errors.find("target relief-bench"), std::string::npos) << result.errors;
    EXPECT_NE(run({"--help"}).output.find("bench"), std::string::npos);
}

TEST_F(Bench, keeps_the_measures_where_no_chart_can_be_drawn) {
    const std::filesystem::path built = program_.parent_path();
    for (const char* name : {"relief", "relief-bench"})
        std::filesystem::copy_file(built / name, folder_ / name);
    program_ = folder_ / "relief";
    const CommandResult result = run({"bench", "paper3", "--quick", "--scenes", "body", "-q"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_NE(result.errors.find("relief-plot-bench paper3/paper3.json draws them"), std::string::npos)
        << result.errors;
    EXPECT_TRUE(exists("paper3/paper3.json"));
    EXPECT_TRUE(exists("paper3/paper3.csv"));
    EXPECT_FALSE(exists("paper3/paper3_body.svg"));
}

TEST_F(Bench, answers_for_its_options_itself) {
    EXPECT_NE(run({"bench", "--help"}).output.find("relief bench [OPTIONS] [suite]"), std::string::npos);
    const CommandResult result = run({"bench", "paper1", "--scnes", "bark"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.errors.find("--scenes"), std::string::npos) << result.errors;
}

TEST_F(Bench, ends_by_the_signal_that_was_sent_to_the_command) {
    const pid_t process = start({"bench", "paper1", "--scenes", "bark", "-o", "a"});
    while (!exists("a")) usleep(1000);
    kill(process, SIGTERM);
    EXPECT_EQ(finish(process).exit_code, 128 + SIGTERM);
}

TEST_F(Bench, wrong_suites_and_scenes_are_usage_errors) {
    const CommandResult suite = run({"bench", "paper7"});
    EXPECT_EQ(suite.exit_code, 2);
    EXPECT_NE(suite.errors.find("paper1"), std::string::npos);
    EXPECT_EQ(run({"bench", "--scenes", "pumpkim"}).exit_code, 2);
    EXPECT_EQ(run({"bench", "--scenes", ""}).exit_code, 2);
    EXPECT_EQ(run({"bench", "--runs", "0"}).exit_code, 2);
    EXPECT_EQ(run({"bench", "paper1", "--mesh", "a.obj"}).exit_code, 2);
}

} // namespace
} // namespace relief::cli
