// docs/scene.schema.json and the reader agree: the same keys in every section, the same names, and the limits
// of `render`.
#include <algorithm>
#include <fstream>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/scene/scene_keys.h"
#include "io/scene/subdivision_json.h"
#include "relief/scene.h"
#include "scene/displacement_conventions.h"
#include "scene/material_inputs.h"
#include "scene/words.h"

namespace relief {

namespace {

using nlohmann::json;
using Names = std::set<std::string>;

json load_schema() {
    std::ifstream stream(RELIEF_SCHEMA);
    return json::parse(stream);
}

const json& at(const json& root, const char* pointer) { return root.at(json::json_pointer(pointer)); }

/// Keys of one object of the schema, which must allow no others.
Names get_keys(const json& object) {
    EXPECT_EQ(object.at("additionalProperties"), false);
    Names names;
    for (const auto& [name, value] : object.at("properties").items()) names.insert(name);
    return names;
}

Names make_names(std::span<const std::string_view> keys) { return {keys.begin(), keys.end()}; }

size_t count_closed_objects(const json& node) {
    size_t count = 0;
    if (node.is_object() && node.contains("properties") && node["properties"].is_object()) ++count;
    if (node.is_structured())
        for (const json& child : node) count += count_closed_objects(child);
    return count;
}

} // namespace

TEST(Schema, knows_the_keys_that_the_reader_knows) {
    const json schema = load_schema();
    const auto expect_keys = [&](const char* pointer, std::span<const std::string_view> keys) {
        EXPECT_EQ(get_keys(at(schema, pointer)), make_names(keys)) << pointer;
    };
    expect_keys("", scene_keys::kRoot);
    expect_keys("/properties/render", scene_keys::kPicture);
    expect_keys("/properties/camera", scene_keys::kCamera);
    expect_keys("/properties/environment", scene_keys::kEnvironment);
    expect_keys("/properties/materials/additionalProperties", list_material_keys());
    expect_keys("/properties/displacements/additionalProperties", scene_keys::kDisplacement);
    expect_keys("/properties/materials/additionalProperties/properties/base_color_texture/oneOf/1",
                scene_keys::kColorTexture);
    for (const char* texture :
         {"/properties/materials/additionalProperties/properties/roughness_texture/oneOf/1",
          "/properties/materials/additionalProperties/properties/metallic_texture/oneOf/1",
          "/properties/materials/additionalProperties/properties/opacity_texture/oneOf/1"})
        expect_keys(texture, scene_keys::kDataTexture);
    for (const char* texture :
         {"/properties/materials/additionalProperties/properties/normal_texture/oneOf/1",
          "/properties/materials/additionalProperties/properties/geometry_normal/oneOf/1"})
        expect_keys(texture, scene_keys::kNormalTexture);
    for (const char* texture : {"/$defs/number_texture", "/$defs/color_texture", "/$defs/emission_texture",
                                "/$defs/luminance_texture"})
        expect_keys(texture, scene_keys::kInputTexture);
    expect_keys("/properties/meshes/additionalProperties", scene_keys::kMesh);
    expect_keys("/properties/meshes/additionalProperties/properties/subdivision", scene_keys::kSubdivision);
    expect_keys("/properties/objects/items", scene_keys::kObject);
    expect_keys("/properties/objects/items/properties/instances", scene_keys::kInstances);
    expect_keys("/properties/lights/items/oneOf/0", scene_keys::kSun);
    expect_keys("/properties/lights/items/oneOf/1", scene_keys::kPoint);
    expect_keys("/properties/lights/items/oneOf/2", scene_keys::kRectangle);
    expect_keys("/properties/lights/items/oneOf/3", scene_keys::kDisk);
    expect_keys("/properties/lights/items/oneOf/4", scene_keys::kSpot);
    // A transform is either parts or a matrix.
    Names transform;
    for (const json& choice : at(schema, "/properties/objects/items/properties/transform/oneOf"))
        transform.merge(get_keys(choice));
    EXPECT_EQ(transform, make_names(scene_keys::kTransform));
    expect_keys("/$defs/keys", scene_keys::kKeyed);
    EXPECT_EQ(count_closed_objects(schema), 28u) << "an object of the schema is compared with nothing";
}

TEST(Schema, has_a_texture_for_each_input_that_may_have_one) {
    const json schema = load_schema();
    const json& keys = at(schema, "/properties/materials/additionalProperties/properties");
    Names with_texture;
    for (const auto& [name, value] : keys.items())
        if (value.contains("oneOf") && value["oneOf"].at(1).contains("$ref")) {
            with_texture.insert(name);
            const std::string target = value["oneOf"][1]["$ref"];
            EXPECT_EQ(target.find("#/$defs/"), 0u);
            EXPECT_TRUE(schema.at("$defs").contains(target.substr(8))) << name;
        }
    Names expected;
    for (const MaterialInputKind& kind : list_material_inputs()) {
        if (kind.input == MaterialInput::normal) continue;
        expected.insert(kind.name);
        if (kind.alias) expected.insert(kind.alias);
    }
    EXPECT_EQ(with_texture, expected);
}

TEST(Schema, names_only_what_the_reader_takes) {
    const json schema = load_schema();
    const json& map = at(schema, "/properties/displacements/additionalProperties/properties");
    for (const std::string name : map.at("type").at("enum"))
        EXPECT_NO_THROW(parse_word<DisplacementType>(name));
    for (const std::string name : map.at("space").at("enum"))
        EXPECT_NO_THROW(parse_word<DisplacementSpace>(name));
    for (const std::string name : map.at("wrap").at("enum")) EXPECT_NO_THROW(parse_word<WrapMode>(name));
    for (const std::string name : map.at("encoding").at("enum"))
        EXPECT_NO_THROW(parse_word<MapEncoding>(name));
    const json& subdivision =
        at(schema, "/properties/meshes/additionalProperties/properties/subdivision/properties");
    for (const std::string name : subdivision.at("scheme").at("enum"))
        EXPECT_NO_THROW(parse_word<SubdivisionScheme>(name));
    for (const std::string name : subdivision.at("uv").at("enum")) EXPECT_NO_THROW(parse_word<UvRule>(name));
    for (const std::string name : subdivision.at("boundary").at("enum"))
        EXPECT_NO_THROW(parse_word<BoundaryRule>(name));
    const std::vector<std::string> presets = map.at("preset").at("enum");
    const std::span<const std::string_view> known = get_preset_names();
    EXPECT_EQ(Names(presets.begin(), presets.end()), make_names(known));
}

TEST(Schema, has_the_limits_of_the_library) {
    const json schema = load_schema();
    const json& render = at(schema, "/properties/render/properties");
    EXPECT_EQ(render.at("width").at("maximum"), kMaxPictureSize);
    EXPECT_EQ(render.at("height").at("maximum"), kMaxPictureSize);
    EXPECT_EQ(render.at("spp").at("maximum"), kMaxSamples);
    EXPECT_EQ(render.at("bounces").at("maximum"), kMaxBounces);
    EXPECT_EQ(
        at(schema, "/properties/meshes/additionalProperties/properties/subdivision/properties/level/oneOf")
            .at(0)
            .at("maximum"),
        kMaxSubdivisionLevel);
    EXPECT_EQ(render.at("seed").at("maximum"), 4294967295u);
}

} // namespace relief
