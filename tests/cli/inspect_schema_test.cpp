// docs/inspect.schema.json against what inspect --json prints.
#include <algorithm>
#include <fstream>
#include <limits>
#include <regex>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "command.h"
#include "relief/io.h"

namespace relief::cli {
namespace {

using nlohmann::json;

bool has_type(const json& value, const std::string& type) {
    return (type == "object" && value.is_object()) || (type == "array" && value.is_array()) ||
           (type == "string" && value.is_string()) || (type == "number" && value.is_number()) ||
           (type == "null" && value.is_null());
}

bool has_one_of(const json& value, const json& types) {
    if (types.is_string()) return has_type(value, types);
    for (const json& type : types)
        if (has_type(value, type)) return true;
    return false;
}

/// Calls `report` with the place of each value that a schema refuses. Of JSON Schema only the words that the
/// file has; any other is reported as well.
template <class Report>
void validate(const json& value, const json& schema, const std::string& place, const Report& report) {
    for (const auto& [word, wanted] : schema.items()) {
        if (word == "type") {
            if (!has_one_of(value, wanted)) report(place + " has another type");
        } else if (word == "enum") {
            if (std::find(wanted.begin(), wanted.end(), value) == wanted.end())
                report(place + " is " + value.dump());
        } else if (word == "pattern") {
            if (!value.is_string() ||
                !std::regex_search(value.get<std::string>(), std::regex(wanted.get<std::string>())))
                report(place + " is " + value.dump());
        } else if (word == "required") {
            for (const json& key : wanted)
                if (!value.contains(key.get<std::string>())) report(place + " has no " + key.dump());
        } else if (word == "items") {
            for (const json& item : value) validate(item, wanted, place + "[]", report);
        } else if (word == "properties") {
            for (const auto& [key, part] : wanted.items())
                if (value.contains(key)) validate(value[key], part, place + "." + key, report);
        } else if (word == "additionalProperties") {
            for (const auto& [key, part] : value.items()) {
                if (schema.contains("properties") && schema["properties"].contains(key)) continue;
                if (wanted == false)
                    report(place + " has " + key);
                else
                    validate(part, wanted, place + "." + key, report);
            }
        } else if (word != "$schema" && word != "title" && word != "description") {
            report("the schema has " + word);
        }
    }
}

json load_schema() {
    std::ifstream stream(RELIEF_INSPECT_SCHEMA);
    return json::parse(stream);
}

size_t count_faults(const json& value) {
    size_t faults = 0;
    validate(value, load_schema(), "output", [&](const std::string&) { ++faults; });
    return faults;
}

class InspectSchema : public CommandTest {
  protected:
    json inspect(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "inspect");
        arguments.push_back("--json");
        const json output = json::parse(run(arguments).output);
        validate(output, load_schema(), "output",
                 [&](const std::string& fault) { ADD_FAILURE() << arguments[1] << ": " << fault; });
        return output;
    }
    /// The number that a text begins with is the value of the fact.
    void expect_value(const json& output, const std::string& name, double value, const char* unit) {
        ASSERT_TRUE(output["values"].contains(name)) << name;
        EXPECT_EQ(output["values"][name]["value"], value) << name;
        EXPECT_EQ(output["values"][name]["unit"], unit) << name;
    }
};

TEST_F(InspectSchema, refuses_what_inspect_does_not_print) {
    json output = {{"file", "a"},
                   {"facts", {{"faces", "1"}}},
                   {"values", {{"faces", {{"value", 1}, {"unit", "count"}}}}},
                   {"findings", {{{"severity", "note"}, {"code", "I-UDIM"}, {"text", "t"}}}}};
    EXPECT_EQ(count_faults(output), 0u);
    json changed = output;
    changed["values"]["faces"]["value"] = "1";
    changed["values"]["faces"]["unit"] = "apples";
    changed["findings"][0]["code"] = "udim";
    changed["facts"]["faces"] = 1;
    changed["more"] = 1;
    changed.erase("file");
    EXPECT_EQ(count_faults(changed), 6u);
}

TEST_F(InspectSchema, describes_a_map_and_a_picture) {
    const json map = inspect({"bump.exr"});
    expect_value(map, "channels", 3, "count");
    EXPECT_GT(map["values"]["size.width"]["value"], 0);
    EXPECT_GT(map["values"]["R.high"]["value"], map["values"]["R.low"]["value"]);
    Image picture = read_image(folder_ / "bump.exr");
    for (float& value : picture.pixels) value = 0.5f + 0.25f * value;
    write_image(picture, folder_ / "picture.png");
    expect_value(inspect({"picture.png"}), "type", 8, "bits");
    picture.pixels[0] = std::numeric_limits<float>::quiet_NaN();
    write_image(picture, folder_ / "nan.exr");
    inspect({"nan.exr"});
}

TEST_F(InspectSchema, describes_a_mesh_and_a_mesh_with_a_map) {
    const json mesh = inspect({"plane.obj"});
    expect_value(mesh, "faces", 1, "count");
    expect_value(mesh, "faces.quads", 1, "count");
    expect_value(mesh, "points.of_2_edges", 4, "count");
    EXPECT_EQ(mesh["values"]["bounds.low_x"]["unit"], "scene units");
    expect_value(inspect({"bump.exr", "--mesh", "plane.obj"}), "mesh.uv_islands", 1, "count");
}

TEST_F(InspectSchema, describes_a_scene) {
    write("scene.json", R"({"render": {"width": 64, "height": 48, "spp": 2},
        "displacements": {"bump": {"type": "vector", "file": "bump.exr", "preset": "blender-brush"}},
        "meshes": {"plane": {"file": "plane.obj"}}, "environment": {"color": [1, 1, 1]},
        "objects": [{"name": "a", "mesh": "plane", "displacement": "bump"}, {"name": "b", "mesh": "plane"}]})");
    const json scene = inspect({"scene.json"});
    expect_value(scene, "objects", 2, "count");
    expect_value(scene, "objects.displaced", 1, "count");
    expect_value(scene, "lights.environments", 1, "count");
    expect_value(scene, "time.samples", 2, "count");
    EXPECT_GT(scene["values"]["time"]["value"], scene["values"]["time.ready"]["value"]);
    for (const char* name : {"geometry", "structures", "map_texels", "tessellated"}) {
        const std::string text = scene["facts"][name];
        EXPECT_EQ(scene["values"][name]["value"], std::stoul(text)) << name;
        EXPECT_EQ(scene["values"][name]["unit"], "bytes");
    }
    EXPECT_TRUE(scene["values"].contains("map.bump.size.width"));
    inspect({"missing.exr"});
}

} // namespace
} // namespace relief::cli
