// How many rays tests for leaks cast in all, and the random numbers that they take.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "math/vec.h"

namespace relief::test {

/// RELIEF_LEAK_RAYS, else ten million.
inline uint64_t leak_ray_count() {
    const char* text = std::getenv("RELIEF_LEAK_RAYS");
    return text ? std::strtoull(text, nullptr, 10) : 10000000;
}

/// Small, fast, seeded by the batch, so that a leak can be found again.
struct LeakRandom {
    uint64_t state;
    float uniform() {
        state = state * 6364136223846793005ull + 1442695040888963407ull;
        return float(state >> 40) * 0x1p-24f;
    }
    Vec3f direction() {
        const float z = 2 * uniform() - 1, angle = 6.2831853f * uniform(),
                    r = std::sqrt(std::fmax(0.0f, 1 - z * z));
        return {r * std::cos(angle), r * std::sin(angle), z};
    }
};

} // namespace relief::test
