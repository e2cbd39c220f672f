// Values of textures, whatever their stride (relief/image.h).
#pragma once

#include <cstddef>
#include <cstdint>

#include "relief/half.h"
#include "relief/image.h"

namespace relief {

/// Has one of the strides that textures may have, and as many values as its size says.
inline bool is_complete(const Texture& texture) {
    if (texture.stride != 4 && texture.stride != Texture::choose_stride(texture.channel_count)) return false;
    const size_t floats = texture.floats.size(), halves = texture.halves.size();
    return texture.width > 0 && texture.height > 0 && (floats == 0 || halves == 0) &&
           floats + halves == texture.value_count();
}

/// Texels of the same kind as `texture`'s, all values 0.
inline void make_values_like(const Texture& texture, Texture& made) {
    made.channel_count = texture.channel_count, made.source_type = texture.source_type;
    made.stride = texture.stride;
    if (texture.halves.empty())
        made.floats.assign(made.value_count(), 0);
    else
        made.halves.assign(made.value_count(), 0);
}

inline float load_value(const Texture& texture, size_t place) {
    return texture.halves.empty() ? texture.floats[place] : half_to_float(texture.halves[place]);
}

/// Rounded where the texture holds halves; what is not finite becomes their greatest there.
inline void store_value(Texture& texture, size_t place, float value) {
    if (texture.halves.empty())
        texture.floats[place] = value;
    else
        texture.halves[place] = float_to_half(value);
}

/// `count` values as they are, between textures that hold the same kind.
inline void copy_values(const Texture& from, size_t from_place, Texture& to, size_t to_place, size_t count) {
    for (size_t k = 0; k < count; ++k)
        if (from.halves.empty())
            to.floats[to_place + k] = from.floats[from_place + k];
        else
            to.halves[to_place + k] = from.halves[from_place + k];
}

/// Of the texel whose values begin at `place`; what it does not have is 0, a fourth channel 1.
inline float load_channel(const Texture& texture, size_t place, size_t channel) {
    if (channel < texture.stride) return load_value(texture, place + channel);
    return channel == 3 ? 1.0f : 0.0f;
}

} // namespace relief
