// What is handed to Blender: the scenes, and the script that reads their files.
#ifdef RELIEF_BENCH_FILES
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/cycles.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief::bench {
namespace {

std::set<std::string> list_keys_without_default(const std::string& script, const std::string& name) {
    const std::regex pattern(name + R"re(\["(\w+)"\])re");
    std::set<std::string> keys;
    for (std::sregex_iterator k(script.begin(), script.end(), pattern), end; k != end; ++k)
        keys.insert((*k)[1]);
    return keys;
}

TEST(CyclesScene, is_white_and_lit_by_the_sky_alone) {
    for (const std::string name : {"rock", "pumpkin"}) {
        const Scene scene = make_cycles_scene(name);
        EXPECT_TRUE(scene.lights.empty()) << name;
        ASSERT_TRUE(scene.environment && scene.environment->texture) << name;
        ASSERT_EQ(scene.materials.size(), 1u) << name;
        EXPECT_EQ(scene.materials[0].ior, 1) << name;
        EXPECT_EQ(scene.materials[0].roughness, 1) << name;
        EXPECT_TRUE(scene.materials[0].textures.empty()) << name;
        EXPECT_NE(scene.objects.at(0).displacement, kNoIndex) << name;
        EXPECT_NO_THROW(validate_scene(scene)) << name;
    }
    EXPECT_THROW(make_cycles_scene("teapot"), Error);
}

TEST(CyclesScript, is_whole) {
    const std::string script = cycles_script();
    for (const char* words : {"\"\"\"Builds a scene folder", "displacement_method = \"DISPLACEMENT\"",
                              "use_adaptive_subdivision = True", "render_levels = 0", "\n    main()\n"})
        EXPECT_NE(script.find(words), std::string::npos) << words;
}

TEST(CyclesScript, reads_no_key_of_a_displacement_that_a_scene_may_lack) {
    const std::set<std::string> keys = list_keys_without_default(cycles_script(), "entry");
    EXPECT_TRUE(keys.contains("file"));
    EXPECT_TRUE(keys.contains("scale"));
    const std::filesystem::path folder = testing::TempDir() + "relief-cycles-script";
    save_scene(make_cycles_scene("rock"), folder);
    std::ifstream stream(folder / "scene.json");
    const auto scene = nlohmann::json::parse(stream);
    ASSERT_FALSE(scene["displacements"].empty());
    for (const auto& [name, entry] : scene["displacements"].items())
        for (const std::string& key : keys) EXPECT_TRUE(entry.contains(key)) << name << ": " << key;
    std::filesystem::remove_all(folder);
}

} // namespace
} // namespace relief::bench
#endif
