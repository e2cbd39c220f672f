// Texels of displacement maps as numbers: read, written, decoded and encoded.
#pragma once

#include <cstddef>
#include <cstdint>

#include "relief/half.h"
#include "relief/image.h"
#include "relief/scene.h"

namespace relief {

/// The first three channels of a texel inside of the map.
inline Vec3f read_texel(const Texture& texture, uint32_t x, uint32_t y) {
    const size_t place = texture.find_texel(x, y);
    float values[3] = {};
    for (size_t c = 0; c < 3 && c < texture.stride; ++c)
        values[c] =
            texture.halves.empty() ? texture.floats[place + c] : half_to_float(texture.halves[place + c]);
    return {values[0], values[1], values[2]};
}

/// Its inverse, rounded where the map holds halves. The value is finite.
inline void write_texel(Texture& texture, uint32_t x, uint32_t y, const Vec3f& value) {
    const size_t at = texture.find_texel(x, y);
    const float values[] = {value.x, value.y, value.z};
    for (size_t c = 0; c < 3 && c < texture.stride; ++c) {
        if (texture.halves.empty())
            texture.floats[at + c] = values[c];
        else
            texture.halves[at + c] = float_to_half(values[c]);
    }
}

/// Displacement that a value means, along t, b, n or x, y, z; of a height map along n.
inline Vec3f decode_texel(const Displacement& map, const Vec3f& value) {
    const float decoded[] = {(value.x - map.midlevel.x) * map.scale.x,
                             (value.y - map.midlevel.y) * map.scale.y,
                             (value.z - map.midlevel.z) * map.scale.z};
    if (map.type == DisplacementType::height) return {0, 0, decoded[0]};
    float along[3] = {};
    for (size_t c = 0; c < 3; ++c) along[map.axes.axis[c]] = decoded[c] * float(map.axes.sign[c]);
    return {along[0], along[1], along[2]};
}

/// What a further displacement adds to a value. Channels that mean nothing, for a scale of 0 or beyond the
/// first of a height map, get nothing.
inline Vec3f encode_step(const Displacement& map, const Vec3f& displacement) {
    const auto encode = [](float decoded, float scale) { return scale == 0 ? 0 : decoded / scale; };
    if (map.type == DisplacementType::height) return {encode(displacement.z, map.scale.x), 0, 0};
    const float along[] = {displacement.x, displacement.y, displacement.z};
    const auto signed_along = [&](size_t c) { return along[map.axes.axis[c]] * float(map.axes.sign[c]); };
    return {encode(signed_along(0), map.scale.x), encode(signed_along(1), map.scale.y),
            encode(signed_along(2), map.scale.z)};
}

} // namespace relief
