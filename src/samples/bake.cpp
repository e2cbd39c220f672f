#include "samples/bake.h"

#include <algorithm>
#include <bit>

#include "base/check.h"
#include "base/parallel.h"
#include "math/vec.h"

namespace relief::samples {

namespace {

std::shared_ptr<Texture> make_texture(const std::string& file, uint32_t size, Texels texels) {
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = size;
    texture->channel_count = 3;
    texture->file = file;
    texture->source_type = texels == Texels::halves ? SampleType::float16 : SampleType::float32;
    if (texels == Texels::halves)
        texture->halves.resize(size_t(size) * size * 4);
    else
        texture->floats.resize(size_t(size) * size * 4);
    return texture;
}

void store(Texture& texture, uint32_t x, uint32_t y, const Vec3f& value) {
    const size_t at = (size_t(y) * texture.width + x) * 4;
    for (int c = 0; c < 4; ++c) {
        const float channel = c == 3 ? 1.0f : get_component(value, c);
        if (texture.halves.empty())
            texture.floats[at + size_t(c)] = channel;
        else
            texture.halves[at + size_t(c)] = float_to_half(channel);
    }
}

} // namespace

uint16_t float_to_half(float value) {
    const uint32_t bits = std::bit_cast<uint32_t>(value), sign = (bits >> 16) & 0x8000u;
    const uint32_t magnitude = bits & 0x7fffffffu;
    if (magnitude >= 0x477fe000u) return uint16_t(sign | 0x7bffu);
    if (magnitude < 0x38800000u) {
        // Below the normal halves the sum with 0.5 rounds to multiples of 2^-24, the spacing of the
        // denormals.
        const float shifted = std::bit_cast<float>(magnitude) + 0.5f;
        return uint16_t(sign | (std::bit_cast<uint32_t>(shifted) - 0x3f000000u));
    }
    const uint32_t rounded = magnitude - 0x38000000u + 0xfffu + ((magnitude >> 13) & 1u);
    return uint16_t(sign | (rounded >> 13));
}

Maps bake_maps(const std::string& name, uint32_t size, Texels texels,
               const std::function<MapSample(Vec2f uv)>& sample) {
    DCHECK(size % 2 == 0);
    const auto displacement = make_texture(name + "_displacement", size, texels);
    const auto color = make_texture(name + "_color", size / 2, Texels::halves);
    const auto bake_row_pair = [&](uint32_t pair) {
        for (uint32_t x = 0; x < size / 2; ++x) {
            Vec3f mean;
            for (uint32_t k = 0; k < 4; ++k) {
                const uint32_t column = 2 * x + k % 2, row = 2 * pair + k / 2;
                const Vec2f uv{(float(column) + 0.5f) / float(size), 1 - (float(row) + 0.5f) / float(size)};
                const MapSample value = sample(uv);
                store(*displacement, column, row, value.displacement);
                mean += value.color * 0.25f;
            }
            store(*color, x, pair, min(max(mean, Vec3f{}), Vec3f{1, 1, 1}));
        }
    };
    parallel_for("bake maps", size / 2, 16, [&](size_t begin, size_t end) {
        for (size_t pair = begin; pair < end; ++pair) bake_row_pair(uint32_t(pair));
    });
    return {displacement, color};
}

} // namespace relief::samples
