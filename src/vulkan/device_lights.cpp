#include "vulkan/device_lights.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "formulas/ggx_table.h"
#include "formulas/light_source.h"
#include "formulas/light_tree.h"
#include "prepare/environment_distribution.h"
#include "prepare/light_sources.h"
#include "vulkan/device_inputs.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/layout/device_paths.h"
#include "vulkan/layout/device_scene.h"

namespace relief::vulkan {

namespace {

/// `values` as a buffer that kernels read.
template <class T>
Buffer make_table(const Device& device, const char* name, TexelFormat format, const std::vector<T>& values,
                  Purpose purpose = Purpose::geometry) {
    Buffer buffer(device,
                  {.name = name, .bytes = values.size() * sizeof(T), .purpose = purpose, .format = format});
    if (!values.empty()) buffer.upload(values);
    return buffer;
}

std::vector<scalar::MaterialData> make_materials(const PreparedScene& scene) {
    std::vector<scalar::MaterialData> result;
    const std::vector<uint32_t>& groups = scene.light_groups.of_material;
    for (const Material& material : scene.materials)
        result.push_back({material.base_color,
                          material.roughness,
                          material.emission,
                          material.metallic,
                          material.ior,
                          material.opacity,
                          {material.normal_scale, material.normal_scale * (material.normal_flip_y ? -1 : 1)},
                          groups.empty() ? kNoIndex : groups[result.size()],
                          0,
                          {},
                          0,
                          {},
                          scalar::kNone,
                          0});
    for (size_t k = 0; k < result.size(); ++k) {
        const scalar::GlassParameters* glass = scene.glass.find(uint32_t(k));
        if (!glass) continue;
        result[k].has_glass = 1;
        result[k].glass = *glass;
    }
    if (scene.layers.empty()) return result;
    for (size_t k = 0; k < result.size(); ++k) {
        const uint32_t record = scene.layers.record_of_material[k];
        if (record == kNoIndex) continue;
        result[k].has_layers = 1;
        result[k].layers = scene.layers.records[record];
    }
    return result;
}

/// The tables of formulas/ggx_table.h and of formulas/layer_table.h.
std::vector<Vec2f> join_albedos(const MaterialLayers& layers) {
    std::vector<Vec2f> entries(scalar::kGgxEntryCount);
    for (uint32_t i = 0; i < entries.size(); ++i) entries[i] = scalar::read_ggx_table(i);
    entries.insert(entries.end(), layers.entries.begin(), layers.entries.end());
    return entries;
}

template <class EmitterItem>
void append_words(const std::vector<EmitterItem>& items, std::vector<uint32_t>& words) {
    static_assert(sizeof(EmitterItem) % sizeof(uint32_t) == 0);
    const size_t first = words.size();
    words.resize(first + items.size() * sizeof(EmitterItem) / sizeof(uint32_t));
    if (!items.empty()) std::memcpy(words.data() + first, items.data(), items.size() * sizeof(EmitterItem));
}

/// The sources, then the nodes of the tree from the next whole node on, then sets of instances; all refer to
/// each other by their places in this buffer.
std::vector<uint32_t> join_sources(LightTables tables, uint32_t& first_node) {
    constexpr size_t source_words = sizeof(scalar::LightSourceData) / sizeof(uint32_t);
    constexpr size_t node_words = sizeof(scalar::LightNodeData) / sizeof(uint32_t);
    const size_t node_place = tables.sources.size() * source_words / node_words + 1;
    const size_t first_link = node_place * node_words + tables.nodes.size() * node_words;
    first_node = tables.nodes.empty() ? 0 : uint32_t(node_place);
    for (scalar::LightNodeData& node : tables.nodes) node.end += first_node;
    for (scalar::LightSourceData& source : tables.sources)
        if (source.link != scalar::kNone) source.link += uint32_t(first_link);
    std::vector<uint32_t> words;
    append_words(tables.sources, words);
    if (tables.nodes.empty() && tables.link_words.empty()) return words;
    words.resize(node_place * node_words);
    append_words(tables.nodes, words);
    append_words(tables.link_words, words);
    return words;
}

/// Emissive patches, followed by the ranges of their instances.
std::vector<scalar::EmitterData> make_emitters(const EmitterTable& table, const LightTables& lights,
                                               uint32_t first_node) {
    std::vector<scalar::EmitterData> result;
    for (uint32_t k = 0; k < table.size(); ++k)
        result.push_back({uint32_t(std::ceil(table.cumulative[k + 1] * double(scalar::kEmitterParts))),
                          std::bit_cast<uint32_t>(table.probability(k))});
    for (uint32_t k = 0; k < lights.leaf_of_emitter.size(); ++k) {
        const uint32_t leaf = lights.leaf_of_emitter[k];
        result[k].probability = leaf == kNoIndex ? scalar::kNone : leaf + first_node;
    }
    for (const EmitterTable::Range& range : table.ranges) result.push_back({range.first, range.instance});
    return result;
}

} // namespace

DeviceLights::DeviceLights(const Device& device, const PreparedScene& scene, const DeviceScene& device_scene)
    : materials_(make_table(device, "materials", TexelFormat::none,
                            join_inputs(make_materials(scene), scene, device_scene))) {
    EnvironmentDistribution distribution;
    if (scene.environment) {
        distribution = make_environment_distribution(*scene.environment);
        description_.environment = make_environment_data(*scene.environment, distribution);
        description_.environment.texture_index = device_scene.texture_index(scene.environment->texture.get());
        description_.has_environment = 1;
    }
    std::vector<float> cumulative = std::move(distribution.rows);
    cumulative.insert(cumulative.end(), distribution.columns.begin(), distribution.columns.end());
    // As large as its image and counted with it, not as geometry.
    environment_ =
        make_table(device, "environment", TexelFormat::r32_float, cumulative, Purpose::displacement);

    const EmitterTable emitters = make_emitter_table(scene);
    description_.emitter_count = emitters.size();
    description_.emitter_range_count = uint32_t(emitters.ranges.size());
    LightTables tables = make_light_tables(scene, distribution.mean_luminance, emitters);
    for (scalar::LightSourceData& source : tables.sources)
        if (source.texture != scalar::kNone)
            source.texture = device_scene.texture_index(tables.textures[source.texture].get());
    description_.source_count = tables.listed_count;
    has_links_ = !tables.link_words.empty(), has_textures_ = !tables.textures.empty();
    sources_ = make_table(device, "light_sources", TexelFormat::none,
                          join_sources(tables, description_.first_light_node), Purpose::structures);
    emitters_ =
        make_table(device, "emitters", TexelFormat::rg32_uint,
                   make_emitters(emitters, tables, description_.first_light_node), Purpose::structures);
    if (!scene.layers.empty())
        albedos_ = make_table(device, "albedos", TexelFormat::rg32_float, join_albedos(scene.layers));
}

void DeviceLights::bind(BindingTable& bindings) const {
    bindings.bind(scalar::kBindMaterials, materials_);
    bindings.bind(scalar::kBindSources, sources_);
    bindings.bind(scalar::kBindEnvironment, environment_);
    bindings.bind(scalar::kBindEmitters, emitters_);
    if (albedos_) bindings.bind(scalar::kBindAlbedos, *albedos_);
}

std::vector<uint32_t> DeviceLights::add_choice(std::vector<uint32_t> constants) const {
    const auto add = [&](uint32_t constant) {
        constants.resize(std::max<size_t>(constants.size(), constant + 1));
        constants[constant] = 1;
    };
    if (description_.first_light_node != 0) add(scalar::kLightTreeConstant);
    if (has_links_) add(scalar::kLightLinksConstant);
    if (has_textures_) add(scalar::kLightTexturesConstant);
    return constants;
}

void DeviceLights::describe(scalar::PathPush& push) const {
    push.source_count = description_.source_count;
    push.first_light_node = description_.first_light_node;
    push.emitter_count = description_.emitter_count;
    push.emitter_range_count = description_.emitter_range_count;
    push.has_environment = description_.has_environment;
    push.environment = description_.environment;
}

} // namespace relief::vulkan
