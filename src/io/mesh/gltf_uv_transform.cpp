#include "io/mesh/gltf_uv_transform.h"

#include <cmath>

#include <fmt/format.h>

#include "io/count_things.h"

namespace relief {

namespace {

constexpr UvTransform kIdentity = {1, 0, 0, 0, 1, 0};
constexpr int64_t kMostSets = 1 << 16;

/// Calls `visit(texture)` for each member of a material that names a texture, also those of its extensions.
template <class Visit> void visit_textures(const JsonNode& node, const Visit& visit) {
    std::vector<JsonNode> open{node};
    while (!open.empty()) {
        const JsonNode parent = open.back();
        open.pop_back();
        for (const auto& [key, member] : parent.members()) {
            if (!member.is_object() || key == "extras") continue;
            if (key.ends_with("Texture") && member.find("index"))
                visit(member);
            else
                open.push_back(member);
        }
    }
}

/// Offset, then rotation, then scale, as the extension has them.
UvTransform read_uv_transform(const JsonNode& node) {
    Vec2f offset{0, 0}, scale{1, 1};
    float angle = 0;
    if (const auto value = node.find("offset")) offset = value->as_vec2();
    if (const auto value = node.find("scale")) scale = value->as_vec2();
    if (const auto value = node.find("rotation")) angle = value->as_float();
    const float c = std::cos(angle), s = std::sin(angle);
    return {c * scale.x, s * scale.y, offset.x, -s * scale.x, c * scale.y, offset.y};
}

} // namespace

std::optional<UvTransform> GltfUvTransforms::find(const JsonNode& primitive, int uv_set) {
    const auto index = primitive.find("material");
    if (!index) return std::nullopt;
    if (!materials_) materials_ = file_.list("materials");
    const JsonNode& material = GltfFile::resolve(*index, *materials_, "material");
    const auto [found, is_new] = found_.try_emplace({&material, uv_set});
    if (is_new) found->second = find_common(material, uv_set);
    return found->second;
}

std::optional<UvTransform> GltfUvTransforms::find_common(const JsonNode& material, int uv_set) {
    std::optional<UvTransform> common;
    bool is_common = true;
    visit_textures(material, [&](const JsonNode& texture) {
        const auto extensions = texture.find("extensions");
        const auto said = extensions ? extensions->find("KHR_texture_transform") : std::nullopt;
        auto set = said ? said->find("texCoord") : std::nullopt;
        if (!set) set = texture.find("texCoord");
        if ((set ? set->as_integer(0, kMostSets) : 0) != uv_set) return;
        const UvTransform transform = said ? read_uv_transform(*said) : kIdentity;
        is_common = is_common && (!common || *common == transform);
        common = transform;
    });
    if (!is_common) {
        const auto [mixed, is_first] = mixed_.try_emplace(uv_set, Mixed{0, material.path()});
        ++mixed->second.materials;
        return std::nullopt;
    }
    if (!common || *common == kIdentity) return std::nullopt;
    return common;
}

std::vector<std::string> GltfUvTransforms::list_warnings() const {
    std::vector<std::string> warnings;
    for (const auto& [set, mixed] : mixed_)
        warnings.push_back(
            fmt::format("{}: textures of {} have different KHR_texture_transform, and none is "
                        "applied to the uvs of set {}; the first is {}: export with one for all "
                        "textures of a material",
                        file_.name(), count_things(mixed.materials, "material"), set, mixed.first));
    return warnings;
}

std::vector<float> transform_uvs(std::span<const float> uvs, const UvTransform& transform) {
    const UvTransform& t = transform;
    std::vector<float> result;
    result.reserve(uvs.size());
    for (size_t k = 0; k + 1 < uvs.size(); k += 2) {
        result.push_back(t[0] * uvs[k] + t[1] * uvs[k + 1] + t[2]);
        result.push_back(t[3] * uvs[k] + t[4] * uvs[k + 1] + t[5]);
    }
    return result;
}

} // namespace relief
