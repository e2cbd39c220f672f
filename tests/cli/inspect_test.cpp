// What inspect finds in maps, meshes and scenes.
#include <limits>

#include <nlohmann/json.hpp>

#include "command.h"
#include "relief/inspect.h"

namespace relief::cli {
namespace {

bool has_code(const Inspection& inspection, const std::string& code) {
    for (const Finding& finding : inspection.findings) {
        if (finding.code == code) return true;
    }
    return false;
}

/// 8 x 8 texels of a bump in the normal channel and a constant elsewhere.
Texture make_texture(SampleType type, float base) {
    Texture texture;
    texture.width = texture.height = 8;
    texture.channel_count = 3;
    texture.source_type = type;
    for (uint32_t y = 0; y < 8; ++y) {
        for (uint32_t x = 0; x < 8; ++x) {
            const bool is_inside = x > 1 && x < 6 && y > 1 && y < 6;
            texture.floats.insert(texture.floats.end(), {base, base, is_inside ? base + 0.25f : base, 1.0f});
        }
    }
    return texture;
}

TEST(InspectTexture, a_clean_float_map_has_no_findings_and_a_normal_channel) {
    const Inspection inspection = inspect_texture(make_texture(SampleType::float32, 0));
    EXPECT_TRUE(inspection.findings.empty());
    EXPECT_EQ(inspection.facts.back().name, "normal_channel");
    EXPECT_EQ(inspection.facts.back().value.substr(0, 1), "B");
}

TEST(InspectTexture, integer_maps_are_warned_of) {
    EXPECT_TRUE(has_code(inspect_texture(make_texture(SampleType::uint8, 0.5f)), "W-8BIT"));
    EXPECT_TRUE(has_code(inspect_texture(make_texture(SampleType::uint16, 0.5f)), "W-INT16"));
    EXPECT_FALSE(has_code(inspect_texture(make_texture(SampleType::uint16, 0.5f)), "W-BORDER"));
}

TEST(InspectTexture, a_background_away_from_zero_is_named) {
    EXPECT_TRUE(has_code(inspect_texture(make_texture(SampleType::float32, 0.1f)), "W-BORDER"));
}

TEST(InspectTexture, a_bad_texel_is_an_error_with_its_place) {
    Texture texture = make_texture(SampleType::float32, 0);
    texture.floats[4 * (3 * 8 + 5) + 1] = std::numeric_limits<float>::quiet_NaN();
    const Inspection inspection = inspect_texture(texture);
    ASSERT_EQ(inspection.findings.size(), 1u);
    EXPECT_EQ(inspection.findings[0].severity, Severity::error);
    EXPECT_NE(inspection.findings[0].text.find("column 5, row 3"), std::string::npos);
}

TEST(InspectTexture, gray_and_single_channel_maps_are_height_maps) {
    Texture texture = make_texture(SampleType::float32, 0);
    for (size_t i = 0; i < texture.floats.size(); i += 4)
        texture.floats[i] = texture.floats[i + 1] = texture.floats[i + 2];
    EXPECT_TRUE(has_code(inspect_texture(texture), "W-GRAY"));
    texture.channel_count = 1;
    EXPECT_TRUE(has_code(inspect_texture(texture), "W-1CH"));
}

TEST(InspectTexture, a_normal_map_is_recognised) {
    Texture texture = make_texture(SampleType::uint8, 0.5f);
    for (size_t i = 0; i < texture.floats.size(); i += 4) texture.floats[i + 2] = 1;
    EXPECT_TRUE(has_code(inspect_texture(texture), "W-NORMALMAP"));
}

TEST(InspectMesh, missing_uvs_and_bad_indices_are_found) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.face_sizes = {3};
    mesh.position_indices = {0, 1, 2};
    EXPECT_TRUE(has_code(inspect_mesh(mesh), "W-NOUV"));
    EXPECT_TRUE(has_code(inspect_mesh(mesh), "W-TRI"));
    EXPECT_FALSE(has_code(inspect_mesh(mesh), "E-INDEX"));
    mesh.position_indices[2] = 3;
    EXPECT_TRUE(has_code(inspect_mesh(mesh), "E-INDEX"));
}

class Inspect : public CommandTest {};

TEST_F(Inspect, exit_codes_follow_the_findings) {
    EXPECT_EQ(run({"inspect", "bump.exr", "--strict"}).exit_code, 0);
    EXPECT_EQ(run({"inspect", "plane.obj"}).exit_code, 0);
    write("bare.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    const CommandResult bare = run({"inspect", "bare.obj"});
    EXPECT_EQ(bare.exit_code, 0);
    EXPECT_NE(bare.output.find("W-NOUV"), std::string::npos);
    EXPECT_EQ(run({"inspect", "bare.obj", "--strict"}).exit_code, 6);
}

TEST_F(Inspect, a_scene_tells_its_counts_and_costs) {
    write("scene.json", R"({"version": 1, "camera": {"from": [0, 0, 5], "to": [0, 0, 0]},
        "displacements": {"bump": {"type": "vector", "file": "bump.exr", "preset": "blender-brush"}},
        "meshes": {"plane": {"file": "plane.obj"}},
        "objects": [{"name": "a", "mesh": "plane", "displacement": "bump"}, {"name": "b", "mesh": "plane"}]})");
    const CommandResult result = run({"inspect", "scene.json", "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.errors << result.output;
    const nlohmann::json facts = nlohmann::json::parse(result.output)["facts"];
    EXPECT_EQ(facts["objects"], "2, 1 displaced");
    EXPECT_EQ(facts["patches"], "1");
    EXPECT_EQ(facts["triangles"], "2");
    for (const char* key : {"geometry", "structures", "tessellated", "finest_level", "map.bump.size"})
        EXPECT_TRUE(facts.contains(key)) << key;
}

} // namespace
} // namespace relief::cli
