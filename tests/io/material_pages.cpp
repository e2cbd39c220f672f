// The table of material keys in docs/formats.md and the materials of docs/scene.schema.json are those of the
// library. RELIEF_WRITE_PAGES=1 writes them instead of comparing them.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/scene/scene_values.h"
#include "relief/material_inputs.h"

namespace relief {

namespace {

const std::filesystem::path kSchema = RELIEF_SCHEMA, kPage = kSchema.parent_path() / "formats.md";

std::string read_all_text(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void expect_text(const std::filesystem::path& file, const std::string& text) {
    if (std::getenv("RELIEF_WRITE_PAGES")) std::ofstream(file, std::ios::binary) << text;
    EXPECT_TRUE(read_all_text(file) == text) << file.filename() << " differs: RELIEF_WRITE_PAGES=1 writes it";
}

/// Whole numbers have no decimal point.
Json to_number(float value) { return value == std::floor(value) ? Json(int64_t(value)) : to_json(value); }

Json get_default(const MaterialInputKind& kind) {
    const Material plain;
    if (kind.flag) return plain.*kind.flag;
    if (kind.number) return to_number(plain.*kind.number);
    const Vec3f color = plain.*kind.color;
    return {to_number(color.x), to_number(color.y), to_number(color.z)};
}

std::string describe_values(const MaterialInputKind& kind) {
    if (kind.flag) return "`true` or `false` (default)";
    if (kind.input == MaterialInput::emission_luminance) return "0 and more, default 0";
    if (kind.is_emission()) return "three numbers in [0, 1], default 1";
    const std::string range = kind.high == kUnboundedInput ? fmt::format("{:g} and more", kind.low)
                                                           : fmt::format("[{:g}, {:g}]", kind.low, kind.high);
    const std::string unit = *kind.unit ? fmt::format(", {}", kind.unit) : "";
    if (kind.number) return fmt::format("{}{}, default {}", range, unit, get_default(kind).dump());
    return fmt::format("three numbers in {}{}, default {}", range, unit, get_default(kind).at(0).dump());
}

std::string make_table() {
    std::string table = "| key | values | meaning |\n|---|---|---|\n";
    for (const MaterialInputKind& kind : list_material_fields()) {
        if (kind.input == MaterialInput::normal) continue; // it has no value beside its texture
        std::string keys = fmt::format("`{}`", kind.name);
        if (kind.alias && !kind.is_emission()) keys = fmt::format("`{}`, {}", kind.alias, keys);
        table += fmt::format("| {} | {} | {} |\n", keys, describe_values(kind), kind.meaning);
    }
    return table;
}

/// Sets the limits of a number, or of the parts of a colour, which may be one of several choices.
void set_limits(const MaterialInputKind& kind, Json& entry) {
    for (const char* choice : {"oneOf", "anyOf"})
        if (entry.contains(choice)) return set_limits(kind, entry[choice].at(0));
    Json& number = kind.color ? entry.at("items") : entry;
    number["minimum"] = to_number(kind.low);
    if (kind.high != kUnboundedInput) number["maximum"] = to_number(kind.high);
}

} // namespace

TEST(MaterialPages, have_the_keys_of_the_library) {
    const std::string begin = "<!-- material inputs -->\n", end = "<!-- end of material inputs -->\n";
    std::string page = read_all_text(kPage);
    const size_t from = page.find(begin), to = page.find(end);
    ASSERT_LT(from, to);
    ASSERT_NE(to, std::string::npos);
    page.replace(from + begin.size(), to - from - begin.size(), make_table());
    expect_text(kPage, page);
}

TEST(MaterialPages, schema_has_the_limits_and_defaults_of_the_library) {
    Json schema = Json::parse(read_all_text(kSchema));
    Json& entries = schema.at(Json::json_pointer("/properties/materials/additionalProperties/properties"));
    for (const MaterialInputKind& kind : list_material_fields()) {
        for (const char* key : {kind.name, kind.alias}) {
            if (!key) continue;
            Json& entry = entries.at(key);
            const bool is_radiance = kind.is_emission() && key == kind.alias;
            entry["description"] =
                is_radiance
                    ? "Radiance that the surface emits, in place of emission_color and emission_luminance."
                : key == kind.name || kind.input == MaterialInput::normal
                    ? std::string(kind.meaning)
                    : fmt::format("Another name of {}.", kind.name);
            if (kind.is_emission() || kind.input == MaterialInput::normal) continue;
            entry["default"] = get_default(kind);
            if (!kind.flag) set_limits(kind, entry);
        }
    }
    expect_text(kSchema, schema.dump(1) + "\n");
}

} // namespace relief
