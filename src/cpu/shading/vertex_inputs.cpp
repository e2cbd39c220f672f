#include "cpu/shading/vertex_inputs.h"

#include <span>

#include "cpu/shading/input_look_up.h"

namespace relief::cpu {

VertexInputs::VertexInputs(const PreparedScene& scene, size_t vertex_count)
    : scene_(scene),
      has_layers_(scene.textured.has_vertex_numbers && !scene.layers.empty()),
      has_glass_(scene.textured.has_vertex_numbers && !scene.glass.empty()) {
    if (has_layers_) {
        layers_ = scene.layers.records, entries_ = scene.layers.entries;
        layers_.resize(layers_.size() + vertex_count);
        entries_.resize(entries_.size() + vertex_count * scene.layers.vertex_entries);
    }
    if (has_glass_) {
        glass_ = scene.glass.records;
        glass_.resize(glass_.size() + vertex_count), glass_of_vertex_.resize(vertex_count);
    }
}

LayerView VertexInputs::layers() const {
    const MaterialLayers& found = scene_.layers;
    const auto& records = has_layers_ ? layers_ : found.records;
    const auto& entries = has_layers_ ? entries_ : found.entries;
    return {records.data(), entries.data(), uint32_t(entries.size())};
}

void VertexInputs::set_textured(size_t n, const TraceHit& hit, const Vec2f& uv, PointMaterial& material) {
    const TexturedMaterial* textured = scene_.textured.find(scene_.instances[hit.instance].material);
    if (!textured || !textured->has_vertex_numbers) return;
    scalar::InputNumbers numbers = textured->numbers;
    numbers.word[scalar::kInputBaseColor] = material.base_color.x;
    numbers.word[scalar::kInputBaseColor + 1] = material.base_color.y;
    numbers.word[scalar::kInputBaseColor + 2] = material.base_color.z;
    numbers.word[scalar::kInputRoughness] = material.roughness;
    numbers.word[scalar::kInputMetallic] = material.metallic;
    numbers =
        find_inputs(std::span(textured->textures).subspan(textured->point_count),
                    ~(scalar::kOpacityPlace | scalar::kNormalPlace), numbers, place_hit(scene_, hit, uv));
    material.base_color = scalar::get_input_color(numbers, scalar::kInputBaseColor);
    material.roughness = numbers.word[scalar::kInputRoughness];
    material.metallic = numbers.word[scalar::kInputMetallic];
    material.emission = scalar::get_input_color(numbers, scalar::kInputEmission);
    if (material.layers != kNoIndex) {
        const MaterialLayers& found = scene_.layers;
        scalar::LayerParameters l =
            scalar::set_layer_inputs(found.records[material.layers], numbers, textured->constants);
        const size_t first = found.entries.size() + n * found.vertex_entries;
        fill_vertex_block({found.entries.data()}, found.grids[material.layers], numbers, l, &entries_[first]);
        l.first_entry = uint32_t(first);
        material.layers = uint32_t(found.records.size() + n);
        layers_[material.layers] = l;
    }
    if (material.glass != kNoIndex) {
        material.glass_numbers = uint32_t(records().size() + n);
        glass_[material.glass_numbers] =
            scalar::set_glass_inputs(records()[material.glass], numbers, textured->constants);
        glass_of_vertex_[n] = material.glass;
    }
}

} // namespace relief::cpu
