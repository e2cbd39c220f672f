#include "image/light_layers.h"

#include <algorithm>

#include "relief/denoise.h"
#include "relief/scene.h"

namespace relief {

bool is_light_group_name(std::string_view name) {
    const auto is_allowed = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
               c == '-';
    };
    return !name.empty() && name.size() <= kMaxLightGroupName && std::ranges::all_of(name, is_allowed);
}

LightLayers find_light_layers(std::span<const std::string> layers) {
    LightLayers result;
    for (const std::string& layer : layers) {
        if (std::ranges::find(kLightKinds, layer) != kLightKinds.end()) result.has_kinds = true;
        if (layer == kDirectLayer) result.has_kinds = true; // it is their sum
        if (std::ranges::find(kDenoiserGuides, layer) != std::end(kDenoiserGuides)) result.has_guides = true;
        if (const std::string_view group = find_group_of_layer(layer); !group.empty())
            result.groups.emplace_back(group);
    }
    std::ranges::sort(result.groups);
    result.groups.erase(std::unique(result.groups.begin(), result.groups.end()), result.groups.end());
    return result;
}

std::string_view find_group_of_layer(std::string_view layer) {
    if (!layer.starts_with(kLightGroupPrefix)) return {};
    const std::string_view group = layer.substr(kLightGroupPrefix.size());
    return is_light_group_name(group) ? group : std::string_view();
}

} // namespace relief
