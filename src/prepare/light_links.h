// Light linking: which instances each light lights, as sets of bits that both engines read.
#pragma once

#include <cstdint>
#include <vector>

#include "relief/scene.h"

namespace relief {

struct LightLinks {
    /// One a light: of its set among `words`; kNoIndex: it lights all. Empty: they all do.
    std::vector<uint32_t> first_word;
    /// Sets, the same one for lights that name the same objects. Bit k % 32 of word k / 32: instance k.
    std::vector<uint32_t> words;
};

/// Of a valid scene, whose objects become instances in their order.
LightLinks make_light_links(const Scene& scene);

} // namespace relief
