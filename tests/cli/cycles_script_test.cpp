// What the script for Blender reads of a scene file, and what save_scene writes into one.
#include <regex>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/cycles.h"
#include "cli/command.h"
#include "relief/io.h"

namespace relief::cli {
namespace {

class CyclesScript : public CommandTest {};

std::set<std::string> list_keys_without_default(const std::string& script, const std::string& name) {
    const std::regex pattern(name + R"re(\["(\w+)"\])re");
    std::set<std::string> keys;
    for (std::sregex_iterator k(script.begin(), script.end(), pattern), end; k != end; ++k)
        keys.insert((*k)[1]);
    return keys;
}

TEST_F(CyclesScript, reads_no_key_of_a_displacement_that_a_scene_may_lack) {
    const std::set<std::string> keys = list_keys_without_default(bench::cycles_script(), "entry");
    EXPECT_TRUE(keys.contains("file"));
    EXPECT_TRUE(keys.contains("scale"));
    save_scene(bench::make_cycles_scene("rock"), folder_);
    const auto scene = nlohmann::json::parse(read("scene.json"));
    ASSERT_FALSE(scene["displacements"].empty());
    for (const auto& [name, entry] : scene["displacements"].items())
        for (const std::string& key : keys) EXPECT_TRUE(entry.contains(key)) << name << ": " << key;
}

} // namespace
} // namespace relief::cli
