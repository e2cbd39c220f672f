#include "prepare/light_links.h"

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "scene/object_names.h"

namespace relief {

namespace {

using Names = std::set<std::string, std::less<>>;

/// Which of the names a light lights, as bytes.
std::vector<uint8_t> choose_lit(const Light& light, const std::vector<std::string_view>& names) {
    const Names includes(light.link_includes.begin(), light.link_includes.end());
    const Names excludes(light.link_excludes.begin(), light.link_excludes.end());
    std::vector<uint8_t> is_lit;
    for (const std::string_view name : names)
        is_lit.push_back((includes.empty() || includes.contains(name)) && !excludes.contains(name));
    return is_lit;
}

} // namespace

LightLinks make_light_links(const Scene& scene) {
    LightLinks links;
    if (std::ranges::none_of(scene.lights, is_linked)) return links;
    links.first_word.assign(scene.lights.size(), kNoIndex);
    // Of a million instances few have names of their own.
    std::map<std::string, uint32_t, std::less<>> number_of_name;
    std::vector<std::string_view> names;
    std::vector<uint32_t> name_of_instance;
    for (const Object& object : scene.objects) {
        const auto [place, is_new] =
            number_of_name.try_emplace(name_object(scene, object), uint32_t(names.size()));
        if (is_new) names.push_back(place->first);
        name_of_instance.push_back(place->second);
    }
    std::map<std::vector<uint8_t>, uint32_t> first_word_of_set;
    for (size_t k = 0; k < scene.lights.size(); ++k) {
        if (!is_linked(scene.lights[k])) continue;
        std::vector<uint8_t> is_lit = choose_lit(scene.lights[k], names);
        const auto [place, is_new] =
            first_word_of_set.try_emplace(std::move(is_lit), uint32_t(links.words.size()));
        links.first_word[k] = place->second;
        if (!is_new) continue;
        links.words.resize(links.words.size() + (scene.objects.size() + 31) / 32);
        for (size_t instance = 0; instance < name_of_instance.size(); ++instance)
            if (place->first[name_of_instance[instance]])
                links.words[place->second + instance / 32] |= 1u << instance % 32;
    }
    return links;
}

} // namespace relief
