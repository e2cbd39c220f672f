// No structure at all: the oracle that the others are compared with, behind the same two functions.
#pragma once

#include <cstdint>

#include "lab/walks/walks.h"

namespace relief {

struct BruteForce {
    uint32_t primitive_count = 0;
};

/// Calls `leaf(primitive_id, ray)` for every primitive, in the order of their indices and whatever their
/// boxes.
template <class Leaf> void closest_hit(const BruteForce& all, BoxRay& ray, Leaf&& leaf) {
    for (uint32_t id = 0; id < all.primitive_count; ++id) leaf(id, ray);
}

/// Whether `leaf(primitive_id, ray)` was true for any primitive; stops at the first.
template <class Leaf> bool any_hit(const BruteForce& all, BoxRay ray, Leaf&& leaf) {
    for (uint32_t id = 0; id < all.primitive_count; ++id)
        if (leaf(id, ray)) return true;
    return false;
}

} // namespace relief
