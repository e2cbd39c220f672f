// What of a mesh file is not read: inspect and convert tell of it, as render does.
#include <nlohmann/json.hpp>

#include "command.h"

namespace relief::cli {
namespace {

/// A triangle with uvs, on a node that a skin would bend.
constexpr const char* kSkinned =
    R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"nodes": [{"name": "body", "mesh": 0, "skin": 0}], "skins": [{"joints": [0]}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
              {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}],
"bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24}],
"buffers": [{"byteLength": 60, "uri": "data:application/octet-stream;base64,)"
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/"
    R"("}]})";

class MeshWarnings : public CommandTest {
  protected:
    void SetUp() override {
        CommandTest::SetUp();
        write("skinned.gltf", kSkinned);
    }
};

TEST_F(MeshWarnings, are_findings_of_inspect) {
    const std::string warning = "skinned.gltf: node 'body' would be bent by a skin";
    const CommandResult alone = run({"inspect", "skinned.gltf"});
    EXPECT_EQ(alone.exit_code, 0) << alone.errors;
    EXPECT_TRUE(contains(alone.output, "warning: W-READ: " + warning)) << alone.output;
    const CommandResult json = run({"inspect", "skinned.gltf", "--json"});
    EXPECT_EQ(nlohmann::json::parse(json.output)["findings"][0]["code"], "W-READ");
    const CommandResult rendered = run({"inspect", "skinned.gltf", "--vdm", "bump.exr"});
    const size_t first = rendered.output.find(warning);
    EXPECT_NE(first, std::string::npos) << rendered.output;
    EXPECT_EQ(rendered.output.find(warning, first + 1), std::string::npos) << "once: " << rendered.output;
    const CommandResult of_map = run({"inspect", "bump.exr", "--mesh", "skinned.gltf"});
    EXPECT_TRUE(contains(of_map.output, "warning: W-READ: mesh: " + warning)) << of_map.output;
}

TEST_F(MeshWarnings, are_told_by_convert_unless_it_is_quiet) {
    const std::string warning = "relief: warning: skinned.gltf: node 'body' would be bent by a skin";
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"convert", "skinned.gltf", "-o", "plain.obj"},
          {"convert", "skinned.gltf", "--vdm", "bump.exr", "--level", "1", "-o", "bumpy.obj"},
          {"convert", "bump.exr", "--mesh", "skinned.gltf", "--to-space", "object", "-o", "object.exr"}}) {
        const CommandResult told = run(arguments);
        EXPECT_EQ(told.exit_code, 0) << told.errors;
        EXPECT_TRUE(contains(told.errors, warning)) << told.errors;
        std::vector<std::string> quietly = arguments;
        quietly.emplace_back("-q");
        const CommandResult quiet = run(quietly);
        EXPECT_EQ(quiet.exit_code, 0) << quiet.errors;
        EXPECT_FALSE(contains(quiet.errors, "skin")) << quiet.errors;
    }
}

} // namespace
} // namespace relief::cli
