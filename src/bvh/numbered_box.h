// A primitive's box as builders move it about: with its number, in two registers of four floats.
#pragma once

#include <cstdint>
#include <limits>

#include "math/box.h"

namespace relief {

/// Four floats that compilers keep in one register; comparisons and choices go lane by lane.
using Float4 = float __attribute__((vector_size(16)));
using Int4 = int32_t __attribute__((vector_size(16)));

inline Float4 make_float4(const Vec3f& v) { return Float4{v.x, v.y, v.z, 0}; }
/// Where one is NaN, the second.
inline Float4 get_lesser(Float4 a, Float4 b) { return a < b ? a : b; }
inline Float4 get_greater(Float4 a, Float4 b) { return a > b ? a : b; }

struct NumberedBox {
    Vec3f lower;
    uint32_t id = 0;
    Vec3f upper;
    uint32_t unused = 0; ///< fills the second register
};
static_assert(sizeof(NumberedBox) == 32);

inline NumberedBox make_numbered_box(const Box& box, uint32_t id) { return {box.lower, id, box.upper, 0}; }

/// A box in two registers; the fourth lanes mean nothing. Begins empty.
struct Box4 {
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();
    Float4 lower{kInfinity, kInfinity, kInfinity, kInfinity};
    Float4 upper{-kInfinity, -kInfinity, -kInfinity, -kInfinity};

    void extend(Float4 low, Float4 high) { lower = get_lesser(low, lower), upper = get_greater(high, upper); }
    void extend(const Box4& other) { extend(other.lower, other.upper); }
    Box to_box() const { return {{lower[0], lower[1], lower[2]}, {upper[0], upper[1], upper[2]}}; }
    /// Of a box that is not empty, in double precision: the area of a box of size 1e30 or 1e-30 is no float.
    double half_area() const {
        const double x = double(upper[0]) - lower[0], y = double(upper[1]) - lower[1];
        const double z = double(upper[2]) - lower[2];
        return x * y + y * z + z * x;
    }
};

inline Float4 compute_centroid(const NumberedBox& member) {
    return make_float4(member.lower) * 0.5f + make_float4(member.upper) * 0.5f;
}

/// What a builder must know of a set before it cuts it: box of the boxes, box of their centroids.
struct SetBounds {
    Box4 box, centroids;

    void extend(const NumberedBox& member) {
        const Float4 low = make_float4(member.lower), high = make_float4(member.upper);
        const Float4 centroid = low * 0.5f + high * 0.5f;
        box.extend(low, high);
        centroids.extend(centroid, centroid);
    }
};

} // namespace relief
