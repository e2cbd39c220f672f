// Textures whose texels are hashes of their numbers: small floats with some large ones among them, or halves.
#pragma once

#include <cstdint>
#include <memory>

#include "formulas/sobol.h"
#include "relief/scene.h"

namespace relief::test {

inline std::shared_ptr<Texture> make_hashed_texture(uint32_t width, uint32_t height, uint32_t channels,
                                                    bool has_halves) {
    auto texture = std::make_shared<Texture>();
    texture->width = width, texture->height = height, texture->channel_count = channels;
    for (uint32_t k = 0; k < 4 * width * height; ++k) {
        const uint32_t value = scalar::hash_uint(k);
        if (has_halves)
            texture->halves.push_back(uint16_t(0x3000 + value % 0x1400));
        else
            texture->floats.push_back(float(value % 1000) * (value % 7 == 0 ? 1.0f : 1e-3f));
    }
    return texture;
}

} // namespace relief::test
