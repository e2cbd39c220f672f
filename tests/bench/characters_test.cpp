// What the suite characters hands to its programs, and what it makes of their measures.
#ifdef RELIEF_BENCH_FILES
#include "bench/characters.h"

#include <filesystem>
#include <fstream>
#include <regex>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/character_session.h"
#include "bench/cycles.h"
#include "relief/error.h"
#include "relief/half.h"
#include "relief/io.h"

namespace relief::bench {
namespace {

class Characters : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::path(testing::TempDir()) /
                  ("relief-characters-" +
                   std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    /// A quad with a map of one value in all texels, half and whole floats.
    CharacterFile write_plate(float value) {
        std::ofstream(folder_ / "plate.obj") << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
                                                "vt 0 1\nf 1/1 2/2 3/3 4/4\n";
        auto texture = std::make_shared<Texture>();
        texture->width = texture->height = 4, texture->channel_count = texture->stride = 3;
        texture->floats.assign(texture->value_count(), value);
        Displacement map;
        map.tiles.push_back({1001, texture});
        write_map(map, folder_ / "plate.exr", MapSamples::float32);
        CharacterFile file{folder_ / "plate.obj", {}};
        file.options.displacement_map = folder_ / "plate.exr";
        file.options.map.space = "object", file.options.map.midlevel = Vec3f{0.5f, 0.5f, 0.5f};
        return file;
    }

    std::filesystem::path folder_;
};

TEST_F(Characters, a_file_becomes_a_white_smooth_surface_under_the_sky) {
    const CharacterInput input = write_character(write_plate(0.75f), folder_ / "scenes");
    EXPECT_EQ(input.name, "plate.obj");
    const Scene scene = load_scene(input.scene);
    EXPECT_EQ(scene.meshes.at(0).subdivision.scheme, SubdivisionScheme::catmark);
    EXPECT_EQ(scene.displacements.at(0).space, DisplacementSpace::object);
    EXPECT_TRUE(scene.environment && scene.environment->texture);
    EXPECT_TRUE(scene.lights.empty());
    EXPECT_EQ(scene.materials.at(scene.objects.at(0).material).name, "white");
    EXPECT_GT(input.move.x, 0);
}

TEST_F(Characters, the_changed_map_displaces_four_fifths_as_far) {
    const CharacterInput input = write_character(write_plate(0.75f), folder_ / "scenes");
    EXPECT_TRUE(input.changed_map.is_absolute());
    const Texture changed = read_texture(input.changed_map);
    EXPECT_FLOAT_EQ(changed.floats.at(0), 0.7f);
}

TEST_F(Characters, tiles_change_all_together_and_stay_halves) {
    const CharacterInput input = write_character("head", CharacterDetail::reduced, folder_);
    EXPECT_NE(input.changed_map.string().find("<UDIM>"), std::string::npos);
    const Scene scene = load_scene(input.scene);
    for (const MapTile& tile : scene.displacements.at(0).tiles) {
        std::string file = input.changed_map.string();
        file.replace(file.find("<UDIM>"), 6, std::to_string(tile.udim));
        const Texture changed = read_texture(file);
        ASSERT_EQ(changed.halves.size(), tile.texture->halves.size()) << file;
        const size_t middle = changed.find_texel(changed.width / 2, changed.height / 2);
        EXPECT_NEAR(half_to_float(changed.halves[middle]), 0.8f * half_to_float(tile.texture->halves[middle]),
                    1e-4f);
    }
}

TEST_F(Characters, a_session_measures_all_four_pictures) {
    const CharacterInput input = write_character(write_plate(0.75f), folder_ / "scenes");
    CharacterTask task;
    task.width = 12, task.height = 16;
    const Measures measures = run_character_session(input, task);
    for (const char* name : {"first_s", "turned_s", "moved_s", "changed_s"})
        EXPECT_GT(measures.at(name), 0) << name;
    CharacterFile plain = write_plate(0);
    plain.options = {};
    const CharacterInput undisplaced = write_character(plain, folder_ / "plain");
    EXPECT_TRUE(undisplaced.changed_map.empty());
    EXPECT_FALSE(run_character_session(undisplaced, task).contains("changed_s"));
}

Value make_ratios(double first, double render, double memory) {
    Value ratios;
    ratios["first_sample"] = summarize({first});
    ratios["render"] = summarize({render});
    ratios["memory"] = summarize({memory});
    return ratios;
}

TEST(CharacterGoals, are_the_ratios_to_cycles_and_stricter_for_the_memory_of_a_crowd) {
    Value goals = Value::list();
    add_character_goals("body", false, make_ratios(1.0, 0.61, 0.5), goals);
    add_character_goals("crowd", true, make_ratios(1.1, 0.6, 0.5), goals);
    ASSERT_EQ(goals.size(), 6u);
    const bool met[] = {true, false, true, false, true, false};
    for (size_t k = 0; k < 6; ++k) EXPECT_EQ(goals[k]["met"], met[k]) << k;
    EXPECT_EQ(goals[2]["goal"], 0.6);
    EXPECT_EQ(goals[5]["goal"], 0.1);
    EXPECT_EQ(goals[0]["name"], "body: first sample");
}

TEST(CharacterScript, sets_what_a_comparison_needs) {
    const std::string script = character_script();
    for (const char* words :
         {"import cycles_scene", "use_persistent_data = arguments.session", "\n    main()\n"})
        EXPECT_NE(script.find(words), std::string::npos) << words;
    const std::string scene = cycles_script();
    for (const char* words : {"CATMULL_CLARK", "adaptive_pixel_size = True, 1.0", "crease_edge", "TILED"})
        EXPECT_NE(scene.find(words), std::string::npos) << words;
}

/// The script reads keys of meshes that a scene may lack by get() alone.
TEST_F(Characters, scene_files_have_the_keys_that_the_script_reads) {
    const CharacterInput input = write_character("body", CharacterDetail::reduced, folder_);
    std::ifstream stream(input.scene);
    const auto scene = nlohmann::json::parse(stream);
    EXPECT_EQ(scene["meshes"]["body"]["subdivision"]["scheme"], "catmark");
    EXPECT_TRUE(scene["meshes"]["body"].contains("file"));
    std::ifstream mesh(folder_ / "body" / scene["meshes"]["body"]["file"].get<std::string>());
    const std::string text{std::istreambuf_iterator<char>(mesh), {}};
    EXPECT_TRUE(std::regex_search(text, std::regex("\nt crease 2/1/0 \\d+ \\d+ [0-9.]+\n")))
        << "as read_obj() of the script expects it";
}

} // namespace
} // namespace relief::bench
#endif
