#include "io/mesh/gltf_extensions.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "io/foreign_files.h"
#include "io/mesh/gltf_compression.h"

namespace relief {

namespace {

constexpr std::array<std::string_view, 5> kApplied = {"EXT_mesh_gpu_instancing", "FB_ngon_encoding",
                                                      "KHR_mesh_quantization", "KHR_node_visibility",
                                                      "KHR_texture_transform"};

/// They say how things look, sound or are called, and move no point. A name that ends with _ stands for all
/// that begin so.
constexpr std::array<std::string_view, 42> kWithoutEffect = {"KHR_materials_",
                                                             "EXT_materials_",
                                                             "ADOBE_materials_",
                                                             "ASOBO_material_",
                                                             "NV_materials_",
                                                             "MSFT_texture_",
                                                             "MSFT_packing_",
                                                             "KHR_xmp",
                                                             "KHR_xmp_",
                                                             "KHR_lights_punctual",
                                                             "KHR_techniques_webgl",
                                                             "KHR_texture_basisu",
                                                             "KHR_texture_procedurals",
                                                             "KHR_audio_emitter",
                                                             "KHR_physics_rigid_bodies",
                                                             "KHR_implicit_shapes",
                                                             "KHR_interactivity",
                                                             "KHR_node_hoverability",
                                                             "KHR_node_selectability",
                                                             "KHR_blend",
                                                             "EXT_lights_",
                                                             "EXT_texture_",
                                                             "EXT_mesh_features",
                                                             "EXT_mesh_manifold",
                                                             "EXT_instance_features",
                                                             "EXT_structural_metadata",
                                                             "EXT_feature_metadata",
                                                             "EXT_collisions_",
                                                             "CESIUM_primitive_outline",
                                                             "AGI_stk_metadata",
                                                             "GODOT_single_root",
                                                             "GRIFFEL_bim_data",
                                                             "MOZ_hubs_components",
                                                             "OMI_",
                                                             "MX_",
                                                             "PANDA3D_physics_",
                                                             "VRM",
                                                             "VRMC_vrm",
                                                             "VRMC_materials_",
                                                             "FB_geometry_metadata",
                                                             "WEB3D_quantized_attributes_metadata",
                                                             "MSFT_lod"};

bool is_without_effect(std::string_view name) {
    return std::ranges::any_of(kWithoutEffect, [&](std::string_view known) {
        return known.ends_with('_') ? name.starts_with(known) : name == known;
    });
}

bool is_applied(std::string_view name) {
    return std::ranges::find(kApplied, name) != kApplied.end() || can_decompress_gltf(name);
}

/// Counts extensions of nodes, meshes and their parts that change them in an unknown way.
class ExtensionCounter {
  public:
    void add(const JsonNode& owner) {
        const auto extensions = owner.find("extensions");
        if (!extensions || !extensions->is_object()) return;
        for (const auto& [name, value] : extensions->members()) {
            if (is_applied(name) || is_without_effect(name)) continue;
            const auto [found, is_new] = counts_.try_emplace(name, Count{0, owner.path()});
            ++found->second.owners;
        }
    }

    std::vector<std::string> list_warnings(const std::string& file) const {
        std::vector<std::string> warnings;
        for (const auto& [name, count] : counts_)
            warnings.push_back(
                fmt::format("{}: the extension {} of {} parts of the file is not read, so their "
                            "shape may differ; the first is {}; export without it",
                            file, name, count.owners, count.first));
        return warnings;
    }

  private:
    struct Count {
        size_t owners;
        std::string first;
    };
    std::map<std::string, Count> counts_; ///< by name
};

} // namespace

void check_gltf_extensions(const GltfFile& file, std::vector<std::string>& warnings) {
    for (const JsonNode& node : file.list("extensionsRequired")) {
        const std::string extension = node.as_string();
        if (is_applied(extension) || is_without_effect(extension)) continue;
        if (const std::optional<ForeignFile> foreign = find_foreign_gltf(extension))
            node.fail(foreign->message, foreign->hint);
        node.fail(fmt::format("needs the extension {}, which is not supported", extension),
                  "export it without this extension");
    }
    ExtensionCounter counter;
    for (const JsonNode& node : file.list("nodes")) counter.add(node);
    for (const JsonNode& mesh : file.list("meshes")) {
        counter.add(mesh);
        if (const auto primitives = mesh.find("primitives"))
            for (const JsonNode& primitive : primitives->elements()) counter.add(primitive);
    }
    for (const JsonNode& name : file.list("extensionsUsed"))
        if (name.as_string() == "KHR_animation_pointer")
            warnings.push_back(fmt::format(
                "{}: Relief does not read KHR_animation_pointer, so the properties that it animates "
                "keep their values: export animations of nodes and weights",
                file.name()));
    for (std::string& warning : counter.list_warnings(file.name())) warnings.push_back(std::move(warning));
}

bool is_hidden_gltf_node(const JsonNode& node) {
    const auto extensions = node.find("extensions");
    const auto visibility = extensions ? extensions->find("KHR_node_visibility") : std::nullopt;
    const auto is_visible = visibility ? visibility->find("visible") : std::nullopt;
    return is_visible && !is_visible->as_bool();
}

} // namespace relief
