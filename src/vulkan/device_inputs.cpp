#include "vulkan/device_inputs.h"

#include <algorithm>
#include <cstring>

namespace relief::vulkan {

namespace {

template <class Item> constexpr size_t kWords = sizeof(Item) / sizeof(uint32_t);

/// First entry of items that lie behind so many words.
template <class Item> size_t find_first(size_t words) { return (words + kWords<Item> - 1) / kWords<Item>; }

template <class Item>
void put_items(const std::vector<Item>& items, size_t first, std::vector<uint32_t>& words) {
    static_assert(sizeof(Item) % sizeof(uint32_t) == 0);
    words.resize(std::max(words.size(), (first + items.size()) * kWords<Item>));
    if (!items.empty())
        std::memcpy(words.data() + first * kWords<Item>, items.data(), items.size() * sizeof(Item));
}

scalar::InputTextureData make_texture(const PlacedTexture& texture, const DeviceScene& device_scene) {
    return {texture.place.first,
            texture.place.count,
            texture.is_number ? 1u : 0u,
            texture.is_udim ? 1u : 0u,
            uint32_t(texture.wrap),
            texture.uv_scale,
            texture.uv_offset,
            0,
            uint32_t(texture.tiles.size()),
            device_scene.uv_set_index(texture.uv_set)};
}

} // namespace

std::vector<uint32_t> join_inputs(std::vector<scalar::MaterialData> materials, const PreparedScene& scene,
                                  const DeviceScene& device_scene) {
    using scalar::InputTextureData;
    using scalar::MaterialInputData;
    const TexturedMaterials& textured = scene.textured;
    const size_t first_input = find_first<MaterialInputData>(materials.size() * kWords<scalar::MaterialData>);
    const size_t first_texture =
        find_first<InputTextureData>((first_input + textured.list.size()) * kWords<MaterialInputData>);
    std::vector<MaterialInputData> inputs;
    std::vector<InputTextureData> textures;
    for (const TexturedMaterial& material : textured.list) {
        inputs.push_back({material.numbers,
                          material.constants,
                          {},
                          material.places,
                          uint32_t(first_texture + textures.size()),
                          uint32_t(material.textures.size())});
        for (const PlacedTexture& texture : material.textures)
            textures.push_back(make_texture(texture, device_scene));
    }
    for (size_t k = 0; k < materials.size(); ++k) {
        const uint32_t place = textured.empty() ? kNoIndex : textured.of_material[k];
        materials[k].inputs = place == kNoIndex ? scalar::kNone : uint32_t(first_input + place);
        materials[k].has_vertex_numbers =
            place != kNoIndex && textured.list[place].has_vertex_numbers ? 1 : 0;
        const uint32_t record = scene.layers.empty() ? kNoIndex : scene.layers.record_of_material[k];
        if (place != kNoIndex && record != kNoIndex) inputs[place].grid = scene.layers.grids[record];
    }
    std::vector<uint32_t> words, tiles;
    size_t first_tile = (first_texture + textures.size()) * kWords<InputTextureData>;
    size_t next = 0;
    for (const TexturedMaterial& material : textured.list)
        for (const PlacedTexture& texture : material.textures) {
            textures[next++].first_tile = uint32_t(first_tile + tiles.size());
            for (const std::shared_ptr<const Texture>& tile : texture.tiles) {
                const uint32_t index = device_scene.texture_index(tile.get());
                tiles.push_back(tile && texture.is_smooth ? index | scalar::kSplineTexture : index);
            }
        }
    put_items(materials, 0, words);
    if (textured.empty()) return words;
    put_items(inputs, first_input, words);
    put_items(textures, first_texture, words);
    put_items(tiles, first_tile, words);
    return words;
}

} // namespace relief::vulkan
