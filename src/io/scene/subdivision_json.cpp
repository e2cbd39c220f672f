#include "io/scene/subdivision_json.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/suggest.h"
#include "io/scene/scene_keys.h"

namespace relief {

namespace {

template <class Value, size_t N> using NameTable = std::array<std::pair<std::string_view, Value>, N>;

constexpr NameTable<SubdivisionScheme, 3> kSchemes{{{"none", SubdivisionScheme::none},
                                                    {"bilinear", SubdivisionScheme::bilinear},
                                                    {"catmark", SubdivisionScheme::catmark}}};
constexpr NameTable<UvRule, 2> kUvRules{{{"smooth", UvRule::smooth}, {"linear", UvRule::linear}}};
constexpr NameTable<BoundaryRule, 2> kBoundaryRules{
    {{"edge-only", BoundaryRule::edge_only}, {"edge-and-corner", BoundaryRule::edge_and_corner}}};

template <class Value, size_t N>
Value find_name(const NameTable<Value, N>& table, std::string_view text, const char* what) {
    std::array<std::string_view, N> names;
    for (size_t k = 0; k < N; ++k) {
        if (table[k].first == text) return table[k].second;
        names[k] = table[k].first;
    }
    throw Error(ErrorKind::bad_input,
                {fmt::format("unknown {} '{}'", what, text), "", suggest_word(text, names)});
}

template <class Value, size_t N> std::string get_name(const NameTable<Value, N>& table, Value value) {
    return std::string(std::find_if(table.begin(), table.end(), [&](const auto& entry) {
                           return entry.second == value;
                       })->first);
}

void add_crease(const JsonNode& node, Mesh& mesh) {
    const std::vector<JsonNode> values = node.elements();
    if (values.size() != 3)
        node.fail(fmt::format("must be two points and a sharpness, not {} values", values.size()),
                  "for example [4, 5, 2.5]; points count from 0");
    const int64_t last = int64_t(mesh.positions.size()) - 1;
    const Crease crease{uint32_t(values[0].as_integer(0, last)), uint32_t(values[1].as_integer(0, last)),
                        values[2].as_float(0)};
    if (std::find(mesh.creases.begin(), mesh.creases.end(), crease) == mesh.creases.end())
        mesh.creases.push_back(crease);
}

void read_creases(const JsonNode& node, Mesh& mesh) {
    if (!node.is_array()) {
        mesh.subdivision.creases = node.as_bool() ? CreaseRule::obey : CreaseRule::ignore;
        return;
    }
    for (const JsonNode& crease : node.elements()) add_crease(crease, mesh);
}

} // namespace

SubdivisionScheme parse_subdivision_scheme(std::string_view text) {
    return find_name(kSchemes, text, "subdivision scheme");
}
UvRule parse_uv_rule(std::string_view text) { return find_name(kUvRules, text, "rule for uvs"); }
BoundaryRule parse_boundary_rule(std::string_view text) {
    return find_name(kBoundaryRules, text, "rule for boundaries");
}

void read_subdivision(const JsonNode& node, Mesh& mesh) {
    if (node.is_string()) {
        const std::string scheme = node.as_string();
        const bool is_known = std::any_of(kSchemes.begin(), kSchemes.end(),
                                          [&](const auto& known) { return known.first == scheme; });
        node.fail("must be an object, not a string",
                  fmt::format(R"({{"scheme": "{}"}})", is_known ? scheme : "catmark"));
    }
    node.check_keys(scene_keys::kSubdivision);
    const auto read_word = [&](const char* key, auto& value, auto parse) {
        if (const auto found = node.find(key))
            value = found->with_place([&] { return parse(found->as_string()); });
    };
    Subdivision& subdivision = mesh.subdivision;
    const JsonNode scheme = node.get("scheme");
    subdivision.scheme = scheme.with_place([&] { return parse_subdivision_scheme(scheme.as_string()); });
    if (const auto level = node.find("level"))
        subdivision.level = int(level->as_integer(0, kMaxSubdivisionLevel));
    read_word("uv", subdivision.uv, parse_uv_rule);
    read_word("boundary", subdivision.boundary, parse_boundary_rule);
    if (const auto creases = node.find("creases")) read_creases(*creases, mesh);
}

bool has_subdivision(const Mesh& mesh) { return !(mesh.subdivision == Subdivision{}); }

Json write_subdivision(const Mesh& mesh) {
    const Subdivision& subdivision = mesh.subdivision;
    Json node;
    node["scheme"] = get_name(kSchemes, subdivision.scheme);
    node["level"] = subdivision.level;
    node["uv"] = get_name(kUvRules, subdivision.uv);
    node["boundary"] = get_name(kBoundaryRules, subdivision.boundary);
    if (subdivision.creases == CreaseRule::ignore) node["creases"] = false; // the mesh file has them
    return node;
}

} // namespace relief
