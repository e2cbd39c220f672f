// Every structure and traversal that `relief devices` lists renders the picture of the default one.
#include <nlohmann/json.hpp>

#include "command.h"

namespace relief::cli {
namespace {

using nlohmann::json;

class Structures : public CommandTest {
  protected:
    void expect_same_pictures(const std::string& engine) {
        const json devices = json::parse(run({"devices", "--json"}).output);
        json structures;
        for (const json& device : devices)
            if (device["engine"] == engine) structures = device["structures"];
        ASSERT_FALSE(structures.is_null()) << "no device";
        const std::vector<std::string> options{"--spp", "1", "--layers", "depth", "--engine", engine};
        ASSERT_EQ(render_bump("default.exr", options).exit_code, 0);
        size_t count = 0;
        for (const auto& [structure, traversals] : structures.items())
            for (const std::string traversal : traversals) {
                std::vector<std::string> all = options;
                all.insert(all.end(), {"--structure", structure, "--traversal", traversal});
                const CommandResult result = render_bump("a.exr", all);
                ASSERT_EQ(result.exit_code, 0) << structure << " " << traversal << ": " << result.errors;
                EXPECT_EQ(run({"compare", "default.exr", "a.exr"}).exit_code, 0)
                    << structure << " " << traversal;
                EXPECT_EQ(run({"compare", "default.exr", "a.exr", "--layer", "depth"}).exit_code, 0)
                    << structure << " " << traversal;
                ++count;
            }
        EXPECT_GE(count, 15u);
    }
};

TEST_F(Structures, on_the_cpu_make_one_picture) { expect_same_pictures("cpu"); }

#ifdef RELIEF_VULKAN
TEST_F(Structures, on_a_device_make_one_picture) { expect_same_pictures("vulkan"); }
#endif

} // namespace
} // namespace relief::cli
