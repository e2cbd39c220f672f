// Axis-aligned boxes. An empty box has lower > upper and is the neutral element of the union.
#pragma once

#include <limits>

#include "math/vec.h"

namespace relief {

struct Box {
    Vec3f lower{std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
                std::numeric_limits<float>::infinity()};
    Vec3f upper{-std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
                -std::numeric_limits<float>::infinity()};

    bool is_empty() const { return !(lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z); }
    void extend(const Vec3f& p) { lower = min(lower, p), upper = max(upper, p); }
    void extend(const Box& b) { lower = min(lower, b.lower), upper = max(upper, b.upper); }
    Vec3f extent() const { return upper - lower; }
    Vec3f center() const { return (lower + upper) * 0.5f; }
    /// Half the surface area; 0 for an empty box.
    float half_area() const {
        if (is_empty()) return 0;
        const Vec3f e = extent();
        return e.x * e.y + e.y * e.z + e.z * e.x;
    }
    bool contains(const Vec3f& p) const {
        return p.x >= lower.x && p.x <= upper.x && p.y >= lower.y && p.y <= upper.y && p.z >= lower.z &&
               p.z <= upper.z;
    }
    bool contains(const Box& b) const { return b.is_empty() || (contains(b.lower) && contains(b.upper)); }
};

} // namespace relief
