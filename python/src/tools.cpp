// What scenes, meshes and maps are; maps in other conventions; what this machine and this build offer.
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "exit_gate.h"
#include "meshes.h"
#include "parts.h"
#include "relief/convert.h"
#include "relief/devices.h"
#include "relief/error.h"
#include "relief/inspect.h"
#include "relief/io.h"
#include "relief/material_inputs.h"
#include "scenes.h"
#include "settings.h"
#include "textures.h"
#include "values.h"

namespace nb = nanobind;

namespace relief::python {

namespace {

nb::object make_number(double number) {
    constexpr double kMostExact = 9007199254740992; // 2^53
    if (!std::isfinite(number)) return nb::none();
    if (number == std::floor(number) && std::fabs(number) <= kMostExact) return nb::int_(int64_t(number));
    return nb::float_(number);
}

/// The keys of `relief inspect --json` but for the file.
nb::dict describe_inspection(const Inspection& inspection) {
    nb::dict facts, values;
    nb::list findings;
    for (const Fact& fact : inspection.facts) {
        facts[fact.name.c_str()] = fact.value;
        for (const FactNumber& number : fact.numbers) {
            nb::dict value;
            value["value"] = make_number(number.value), value["unit"] = number.unit;
            values[(number.part.empty() ? fact.name : fact.name + "." + number.part).c_str()] = value;
        }
    }
    for (const Finding& finding : inspection.findings) {
        constexpr const char* kSeverities[] = {"note", "warning", "error"};
        nb::dict entry;
        entry["severity"] = kSeverities[size_t(finding.severity)];
        entry["code"] = finding.code, entry["text"] = name_keywords(finding.text);
        findings.append(entry);
    }
    nb::dict node;
    node["facts"] = facts, node["values"] = values, node["findings"] = findings;
    return node;
}

template <class Work> nb::dict inspect(const Work& work) {
    Inspection inspection;
    {
        const GateVisit visit;
        const nb::gil_scoped_release release;
        inspection = work();
    }
    return describe_inspection(inspection);
}

nb::dict inspect_parsed(const ParsedScene& parsed, const nb::dict& keywords) {
    const RenderSettings settings = read_settings(keywords, parsed.scene.picture);
    return inspect([&] { return inspect_scene(parsed.scene, settings); });
}

nb::dict inspect_polygons(const nb::dict& arrays) {
    const Mesh mesh = make_mesh(arrays);
    return inspect([&] { return inspect_mesh(mesh); });
}

const Displacement& get_map(const ParsedScene& parsed) {
    if (parsed.scene.displacements.size() != 1)
        throw Error(ErrorKind::usage,
                    {"one displacement is needed", "", "relief.Displacement(array, space=...)"});
    return parsed.scene.displacements.front();
}

/// The one displacement of a scene; `mesh` as for make_mesh, or None.
nb::dict inspect_texels(const ParsedScene& parsed, bool is_declared, const std::optional<nb::dict>& arrays) {
    std::optional<Mesh> mesh;
    if (arrays) mesh = make_mesh(*arrays);
    const Displacement& map = get_map(parsed);
    return inspect([&] {
        return inspect_map(map, is_declared ? MapMeaning::declared : MapMeaning::unknown,
                           mesh ? &*mesh : nullptr);
    });
}

/// Keys of displacements in scene files.
MapOptions read_map_options(const nb::dict& keys) {
    MapOptions options;
    const auto get = [&](const char* key) { return Argument(key, keys[key]); };
    const auto read = [&](const char* key, std::optional<std::string>& value) {
        if (keys.contains(key)) value = get(key).text();
    };
    read("type", options.type), read("space", options.space), read("axes", options.axes);
    read("frame", options.frame), read("lengths", options.lengths), read("encoding", options.encoding);
    if (keys.contains("preset")) options.preset = get("preset").text();
    for (const auto& [key, value] :
         {std::pair("midlevel", &options.midlevel), std::pair("scale", &options.scale)}) {
        if (!keys.contains(key)) continue;
        const nb::object given = keys[key];
        const bool is_one = !PySequence_Check(given.ptr());
        const float all = is_one ? float(get(key).number(-1e9, 1e9)) : 0;
        *value = is_one ? Vec3f{all, all, all} : get(key).vector("a number, or three");
    }
    if (keys.contains("flip_v")) options.flip_v = get("flip_v").truth();
    return options;
}

/// One number where all three are the same.
nb::object make_factors(const Vec3f& v) {
    if (v.x == v.y && v.y == v.z) return nb::float_(v.x);
    nb::list list;
    for (const float value : {v.x, v.y, v.z}) list.append(value);
    return list;
}

/// The keys of a scene file that say what the texels mean, whatever they were asked for by.
nb::dict describe_meaning(const Displacement& map) {
    const MapOptions options = describe_map_meaning(map);
    nb::dict keys;
    for (const auto& [key, word] : {std::pair("type", &options.type), std::pair("space", &options.space),
                                    std::pair("axes", &options.axes), std::pair("frame", &options.frame),
                                    std::pair("lengths", &options.lengths)})
        if (*word) keys[key] = **word;
    keys["midlevel"] = make_factors(*options.midlevel), keys["scale"] = make_factors(*options.scale);
    keys["flip_v"] = options.flip_v;
    return keys;
}

/// Tiles by UDIM numbers as arrays, whether they are tiles, the keys of the new map, and warnings. Without a
/// space, axes or a preset the space stays that of the map.
nb::object convert(const ParsedScene& parsed, const nb::dict& keys, const std::optional<nb::dict>& arrays) {
    const Displacement& from = get_map(parsed);
    MapOptions options = read_map_options(keys);
    if (!options.space && !options.axes && options.preset.empty())
        options.space = describe_map_meaning(from).space;
    const Displacement to = make_map_meaning(options);
    std::optional<Mesh> mesh;
    if (arrays) mesh = make_mesh(*arrays);
    std::vector<std::string> warnings;
    Displacement converted;
    {
        const GateVisit visit;
        const nb::gil_scoped_release release;
        converted = convert_map(from, to, mesh ? &*mesh : nullptr, &warnings);
    }
    nb::dict tiles;
    for (const MapTile& tile : converted.tiles) tiles[nb::int_(tile.udim)] = make_texel_array(*tile.texture);
    return nb::make_tuple(tiles, converted.is_udim, describe_meaning(converted), warnings);
}

std::vector<std::string> list_traversals(const std::string& structure, const std::string& engine) {
    nb::dict keywords;
    keywords["structure"] = structure, keywords["engine"] = engine;
    const IntersectorSettings settings = read_ray_settings(keywords);
    std::vector<std::string> names;
    for (const TraversalKind kind :
         available_traversals(settings.device.engine, settings.experiment.structure))
        names.emplace_back(traversal_name(kind));
    return names;
}

nb::list list_devices() {
    nb::list devices;
    for (const DeviceInfo& info : vulkan_devices()) {
        nb::dict device;
        device["index"] = info.index, device["name"] = info.name, device["driver"] = info.driver;
        device["kind"] = info.kind, device["memory_bytes"] = info.memory_bytes;
        device["missing"] = info.missing, device["methods"] = info.methods;
        devices.append(device);
    }
    return devices;
}

const char* get_type(const MaterialInputKind& kind) {
    if (kind.flag) return "flag";
    if (kind.is_color()) return "color";
    return kind.number || kind.is_emission() ? "number" : "normal";
}

/// Returns the number whose shortest decimals are those of the float: 1.6, not 1.600000023841858.
double to_decimal(float value) {
    const std::string text = fmt::format("{}", value);
    double decimal = 0;
    std::from_chars(text.data(), text.data() + text.size(), decimal);
    return decimal;
}

nb::object get_default(const MaterialInputKind& kind) {
    const Material plain;
    if (kind.flag) return nb::cast(plain.*kind.flag);
    if (kind.number) return nb::cast(to_decimal(plain.*kind.number));
    if (kind.input == MaterialInput::emission_luminance) return nb::cast(to_decimal(plain.emission.x));
    if (!kind.color) return nb::none();
    // Without a luminance the product is black, and the colour itself is white.
    const Vec3f color = kind.is_emission() ? Vec3f{1, 1, 1} : plain.*kind.color;
    nb::list parts;
    for (const float part : {color.x, color.y, color.z}) parts.append(to_decimal(part));
    return parts;
}

nb::list list_inputs() {
    nb::list inputs;
    for (const MaterialInputKind& kind : list_material_fields()) {
        const auto add_text = [](nb::dict& row, const char* key, const char* text) {
            row[key] = text ? nb::object(nb::str(text)) : nb::object(nb::none());
        };
        nb::dict row;
        row["name"] = kind.name;
        add_text(row, "alias", kind.alias);
        row["type"] = get_type(kind);
        row["low"] = kind.low;
        row["high"] = kind.high == kUnboundedInput ? std::numeric_limits<float>::infinity() : kind.high;
        row["default"] = get_default(kind);
        row["unit"] = kind.unit;
        row["is_textured"] = kind.input != kUntextured;
        add_text(row, "texture_key", kind.texture_key);
        row["meaning"] = kind.meaning;
        inputs.append(row);
    }
    return inputs;
}

} // namespace

void add_tools(nb::module_& module) {
    module.def("inspect_scene", &inspect_parsed, nb::arg("scene"), nb::arg("keywords"));
    module.def("inspect_mesh", &inspect_polygons, nb::arg("arrays"));
    module.def("inspect_map", &inspect_texels, nb::arg("scene"), nb::arg("is_declared"),
               nb::arg("mesh").none());
    module.def("convert_map", &convert, nb::arg("scene"), nb::arg("keys"), nb::arg("mesh").none());
    module.def("structures", [] {
        std::vector<std::string> names;
        for (const StructureKind kind : {StructureKind::bvh, StructureKind::lbvh, StructureKind::kdtree})
            names.emplace_back(structure_name(kind));
        return names;
    });
    module.def("traversals", &list_traversals, nb::arg("structure"), nb::arg("engine"));
    module.def("isas", &available_isas);
    module.def("material_inputs", &list_inputs);
    module.def("devices", &list_devices);
}

} // namespace relief::python
