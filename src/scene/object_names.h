// What the objects of a scene are called: in layers of Cryptomatte, and where lights name them.
#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>

#include "relief/scene.h"

namespace relief {

/// Scenes made in memory may hold things without a name; indices are not checked yet.
template <class Item>
std::string name_item(const std::vector<Item>& items, uint32_t index, const char* kind) {
    const bool has_name = index < items.size() && !items[index].name.empty();
    return has_name ? items[index].name : fmt::format("{} {}", kind, uint64_t(index) + 1);
}

/// Its own name, or else that of its mesh.
inline std::string name_object(const Scene& scene, const Object& object) {
    return object.name.empty() ? name_item(scene.meshes, object.mesh, "mesh") : object.name;
}

/// Whether a light lights some objects only.
inline bool is_linked(const Light& light) {
    return !light.link_includes.empty() || !light.link_excludes.empty();
}

} // namespace relief
