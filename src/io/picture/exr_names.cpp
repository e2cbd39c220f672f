#include "io/picture/exr_names.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace relief {

namespace {

/// The standard attributes whose metadata other kinds of files know by another name.
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kNames = {
    {{"owner", "Copyright"}, {"comments", "ImageDescription"}, {"capDate", "DateTime"}}};
constexpr std::array<std::string_view, 3> kOfTheFile = {"name", "type", "view"};

bool is_of_the_file(std::string_view attribute) {
    return std::find(kOfTheFile.begin(), kOfTheFile.end(), attribute) != kOfTheFile.end();
}

} // namespace

std::string get_metadata_name(const std::string& attribute) {
    if (is_of_the_file(attribute)) return {};
    for (const auto& [standard, name] : kNames)
        if (attribute == standard) return std::string(name);
    return attribute;
}

std::string get_attribute_name(const std::string& metadata) {
    for (const auto& [standard, name] : kNames)
        if (metadata == name) return std::string(standard);
    return is_of_the_file(metadata) ? std::string() : metadata;
}

} // namespace relief
