// How many rays tests for leaks cast in all.
#pragma once

#include <cstdint>
#include <cstdlib>

namespace relief::test {

/// RELIEF_LEAK_RAYS, else ten million.
inline uint64_t leak_ray_count() {
    const char* text = std::getenv("RELIEF_LEAK_RAYS");
    return text ? std::strtoull(text, nullptr, 10) : 10000000;
}

} // namespace relief::test
