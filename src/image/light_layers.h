// Layers that share out the light of a picture: over the kinds of formulas/light_kinds.h, which add up to
// its colour, and over groups of lights, which do so where all groups are asked for. Guides of a denoiser go
// with them, as they too are of whole paths.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace relief {

/// Layers of the kinds, in the order of scalar::find_light_kind(), kKindEmission and kKindBackground.
inline constexpr std::array<const char*, 8> kLightKinds{
    "diffuse_direct",      "diffuse_indirect",      "specular_direct", "specular_indirect",
    "transmission_direct", "transmission_indirect", "emission",        "background"};

/// "light_NAME" is the layer of the group NAME.
inline constexpr std::string_view kLightGroupPrefix = "light_";

/// What the layers of a picture need: a colour for each kind where any is asked for, then one a group, then
/// albedo and normal where a guide is asked for.
struct LightLayers {
    bool has_kinds = false, has_guides = false;
    std::vector<std::string>
        groups; ///< their names, each once, rising: the order of a request does not matter

    size_t kind_count() const { return has_kinds ? kLightKinds.size() : 0; }
    size_t first_guide() const { return kind_count() + groups.size(); }
    size_t count() const { return first_guide() + (has_guides ? 2 : 0); }
};

/// `layers`: as ImageSettings has them; other ones are passed over.
LightLayers find_light_layers(std::span<const std::string> layers);

/// The name of the group whose layer has this name; empty: it is none.
std::string_view find_group_of_layer(std::string_view layer);

} // namespace relief
