// Textures with as many values a texel as they have channels, and scenes with all kinds of them.
#pragma once

#include <memory>

#include "image/texel_layout.h"
#include "relief/scene.h"
#include "support/bodies.h"
#include "support/session_scenes.h"

namespace relief::test {

/// The same texels in `stride` values each, of so many channels.
inline Texture make_narrow(const Texture& texture, uint32_t stride) {
    Texture narrow;
    narrow.width = texture.width, narrow.height = texture.height, narrow.file = texture.file;
    narrow.channel_count = narrow.stride = stride, narrow.source_type = texture.source_type;
    if (texture.halves.empty())
        narrow.floats.resize(narrow.value_count());
    else
        narrow.halves.resize(narrow.value_count());
    for (uint32_t y = 0; y < texture.height; ++y)
        for (uint32_t x = 0; x < texture.width; ++x)
            copy_values(texture, texture.find_texel(x, y), narrow, narrow.find_texel(x, y), stride);
    return narrow;
}

/// All images of the scene with as few values a texel as they can have.
inline Scene make_narrow(Scene scene) {
    const auto replace = [](std::shared_ptr<const Texture>& texture) {
        if (texture && (texture->channel_count == 1 || texture->channel_count == 3))
            texture = std::make_shared<const Texture>(make_narrow(*texture, texture->channel_count));
    };
    for (Displacement& map : scene.displacements)
        for (MapTile& tile : map.tiles) replace(tile.texture);
    for (Material& material : scene.materials)
        for (InputTexture& input : material.textures)
            for (MapTile& tile : input.tiles) replace(tile.texture);
    if (scene.environment) replace(scene.environment->texture);
    return scene;
}

/// Four values a texel; of one channel the second and third are 0.
inline std::shared_ptr<Texture> make_wide_map(uint32_t channel_count, SampleType type, float amplitude,
                                              uint32_t seed) {
    std::shared_ptr<Texture> map = make_random_map(53, 31, amplitude, seed);
    map->channel_count = channel_count, map->source_type = type;
    if (channel_count == 1)
        for (size_t k = 0; k < map->floats.size(); k += 4) map->floats[k + 1] = map->floats[k + 2] = 0;
    if (type != SampleType::float16) return map;
    for (const float value : map->floats) map->halves.push_back(float_to_half(value));
    map->floats.clear();
    return map;
}

/// A rough torus under a textured sky, its material with textures of three channels and of one.
inline Scene make_textured_torus(uint32_t channel_count, SampleType type, MapFilter filter) {
    Scene scene = make_rough_torus();
    Displacement& map = scene.displacements[0];
    map.type = channel_count == 1 ? DisplacementType::height : DisplacementType::vector;
    map.filter = filter;
    map.tiles[0].texture = make_wide_map(channel_count, type, 0.05f, 3);
    const auto make_color = [&](uint32_t channels, uint32_t seed) {
        auto color = make_wide_map(channels, type, 0.3f, seed);
        for (float& value : color->floats) value = 0.5f + 0.5f * value;
        for (uint16_t& value : color->halves) value = float_to_half(0.5f + 0.5f * half_to_float(value));
        return color;
    };
    Material material;
    material.textures = {{.input = MaterialInput::base_color, .tiles = {{1001, make_color(3, 5)}}},
                         {.input = MaterialInput::roughness, .tiles = {{1001, make_color(1, 6)}}},
                         {.input = MaterialInput::coat_color, .tiles = {{1001, make_color(3, 7)}}}};
    material.textures[2].filter = MapFilter::bspline;
    material.coat_weight = 0.5f;
    scene.materials.push_back(material);
    scene.objects[0].material = 0;
    scene.environment->texture = make_color(channel_count, 8);
    return scene;
}

} // namespace relief::test
