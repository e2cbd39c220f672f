// JSON that is nested a million levels deep ends in a message, whoever reads it.
#include "command.h"

namespace relief::cli {
namespace {

using Nesting = CommandTest;

constexpr size_t kDeep = 1000000;

TEST_F(Nesting, of_scenes_meshes_edits_and_manifests_is_limited) {
    std::string deep;
    for (size_t k = 0; k < kDeep; ++k) deep += "{\"a\":";
    write("deep.json", "{\"objects\": " + deep);
    write("deep.gltf", "{\"asset\": " + std::string(kDeep, '['));
    write("deep.jsonl", deep + "\n");
    std::filesystem::create_directory(folder_ / "job");
    write("job/job.json", "{\"layout\": " + std::string(kDeep, '[') + std::string(kDeep, ']') + "}");
    for (const std::vector<std::string>& line :
         {std::vector<std::string>{"render", "deep.json", "-o", "o.exr"},
          {"inspect", "deep.json"},
          {"convert", "deep.json", "-o", "o.obj"},
          {"render", "deep.gltf", "-o", "o.exr"},
          {"render", "plane.obj", "--vdm", "bump.exr", "--edits", "deep.jsonl", "--size", "8x8", "-o",
           "o.exr"},
          {"farm", "status", "job"}}) {
        const CommandResult result = run(line);
        EXPECT_EQ(result.exit_code, 3) << line[0] << ' ' << line[1] << ": " << result.errors;
        EXPECT_TRUE(contains(result.errors, "nested more than 256 levels deep")) << result.errors;
    }
}

} // namespace
} // namespace relief::cli
