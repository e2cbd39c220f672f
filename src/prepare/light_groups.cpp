#include "prepare/light_groups.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "image/light_layers.h"
#include "relief/error.h"

namespace relief {

namespace {

std::string complete_name(const std::string& light_group) {
    return light_group.empty() ? kDefaultLightGroup : light_group;
}

/// The default group is there in any case: a background of one colour is in it.
std::set<std::string> list_groups(const LightGivers& from) {
    std::set<std::string> found{kDefaultLightGroup};
    for (const Material& material : from.materials)
        if (!(material.emission == Vec3f{})) found.insert(complete_name(material.light_group));
    for (const Light& light : from.lights) found.insert(complete_name(light.light_group));
    if (from.environment) found.insert(complete_name(from.environment->light_group));
    return found;
}

} // namespace

uint32_t LightGroups::find(const std::string& light_group) const {
    const auto found = std::ranges::find(names, complete_name(light_group));
    return found == names.end() ? kNoIndex : uint32_t(found - names.begin());
}

LightGroups make_light_groups(const LightGivers& from, std::span<const std::string> layers) {
    LightGroups groups;
    groups.names = find_light_layers(layers).groups;
    if (groups.names.empty()) return groups;
    const std::set<std::string> known = list_groups(from);
    for (const std::string& name : groups.names)
        if (!known.contains(name))
            throw Error(ErrorKind::usage,
                        {fmt::format("no light of the scene is in the group '{}' of the layer {}{}", name,
                                     kLightGroupPrefix, name),
                         "layers",
                         known.size() == 1
                             ? "give lights, materials or the environment a light_group"
                             : fmt::format("groups of the scene are {}", fmt::join(known, ", "))});
    for (const Material& material : from.materials)
        groups.of_material.push_back(groups.find(material.light_group));
    groups.of_default = groups.find({});
    if (from.environment) groups.of_environment = groups.find(from.environment->light_group);
    return groups;
}

} // namespace relief
