#include "scene/uv_sets.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

namespace relief {

std::vector<int> list_uv_sets(const Material& material) { return list_uv_sets(std::span(&material, 1)); }

std::vector<int> list_uv_sets(std::span<const Material> materials) {
    std::set<int> numbers;
    for (const Material& material : materials)
        for (const InputTexture& texture : material.textures)
            if (texture.uv_set != kOwnUvSet) numbers.insert(texture.uv_set);
    return {numbers.begin(), numbers.end()};
}

bool has_uv_set(const Mesh& mesh, int number) {
    if (number == mesh.uv_set && !mesh.uv_indices.empty()) return true;
    return find_further_set(mesh, number) != nullptr;
}

const UvSet* find_further_set(const Mesh& mesh, int number) {
    const auto found = std::ranges::find(mesh.further_uvs, number, &UvSet::number);
    return found == mesh.further_uvs.end() ? nullptr : &*found;
}

std::string describe_uv_sets(const Mesh& mesh) {
    std::set<int> numbers;
    if (!mesh.uv_indices.empty()) numbers.insert(mesh.uv_set);
    for (const UvSet& set : mesh.further_uvs) numbers.insert(set.number);
    if (numbers.empty()) return "no uvs";
    std::string list;
    size_t left = numbers.size();
    for (const int number : numbers) {
        list += std::to_string(number);
        --left;
        if (left > 0) list += left == 1 ? " and " : ", ";
    }
    return fmt::format("{} {}", numbers.size() == 1 ? "uv set" : "uv sets", list);
}

} // namespace relief
