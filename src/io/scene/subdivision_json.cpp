#include "io/scene/subdivision_json.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "io/scene/scene_keys.h"
#include "scene/words.h"

namespace relief {

namespace {

constexpr const char* kAutoLevelWord = "auto";

int read_level(const JsonNode& node) {
    if (!node.is_string()) return int(node.as_integer(0, kMaxSubdivisionLevel));
    if (node.as_string() != kAutoLevelWord)
        node.fail(fmt::format("must be \"auto\" or a number, not \"{}\"", node.as_string()),
                  fmt::format("write \"auto\", or a level from 0 to {}", kMaxSubdivisionLevel));
    return kAutoSubdivisionLevel;
}

void add_crease(const JsonNode& node, Mesh& mesh) {
    const std::vector<JsonNode> values = node.elements();
    if (values.size() != 3)
        node.fail(fmt::format("must be two points and a sharpness, not {} values", values.size()),
                  "for example [4, 5, 2.5]; points count from 0");
    const int64_t last = int64_t(mesh.positions.size()) - 1;
    const Crease crease{uint32_t(values[0].as_integer(0, last)), uint32_t(values[1].as_integer(0, last)),
                        values[2].as_float(0)};
    if (std::ranges::find(mesh.creases, crease) == mesh.creases.end()) mesh.creases.push_back(crease);
}

void read_creases(const JsonNode& node, Mesh& mesh) {
    if (!node.is_array()) {
        mesh.subdivision.creases = node.as_bool() ? CreaseRule::obey : CreaseRule::ignore;
        return;
    }
    for (const JsonNode& crease : node.elements()) add_crease(crease, mesh);
}

} // namespace

void read_subdivision(const JsonNode& node, Mesh& mesh) {
    if (node.is_string()) {
        const std::string scheme = node.as_string();
        const auto& known = kWords<SubdivisionScheme>.words;
        const bool is_known = std::ranges::find(known, scheme) != known.end();
        node.fail("must be an object, not a string",
                  fmt::format(R"({{"scheme": "{}"}})", is_known ? scheme : "catmark"));
    }
    node.check_keys(scene_keys::kSubdivision);
    const auto read_word = [&]<class Value>(const JsonNode& word, Value& value) {
        value = word.with_place([&] { return parse_word<Value>(word.as_string()); });
    };
    Subdivision& subdivision = mesh.subdivision;
    read_word(node.get("scheme"), subdivision.scheme);
    if (const auto level = node.find("level")) subdivision.level = read_level(*level);
    if (const auto uv = node.find("uv")) read_word(*uv, subdivision.uv);
    if (const auto boundary = node.find("boundary")) read_word(*boundary, subdivision.boundary);
    if (const auto creases = node.find("creases")) read_creases(*creases, mesh);
}

bool has_subdivision(const Mesh& mesh) { return !(mesh.subdivision == Subdivision{}); }

Json write_subdivision(const Mesh& mesh) {
    const Subdivision& subdivision = mesh.subdivision;
    Json node;
    node["scheme"] = get_word(subdivision.scheme);
    if (subdivision.level == kAutoSubdivisionLevel)
        node["level"] = kAutoLevelWord;
    else
        node["level"] = subdivision.level;
    node["uv"] = get_word(subdivision.uv);
    node["boundary"] = get_word(subdivision.boundary);
    if (subdivision.creases == CreaseRule::ignore) node["creases"] = false; // the mesh file has them
    return node;
}

} // namespace relief
