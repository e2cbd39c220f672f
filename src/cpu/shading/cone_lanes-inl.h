// Directions within a cone, sixteen at once: bit-identical to those of scalar::draw_sun.
#pragma once

#include "cpu/traversal/lane_arrays-inl.h"
#include "formulas/basis.h"
#include "formulas/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE::wide {

/// A unit vector for each pair of random numbers, uniformly from the cone about axes.n; `height` as that of
/// square_to_cone().
inline void draw_cone(const scalar::Basis& axes, float height, const Vec2f* u, size_t count,
                      Vec3f* directions) {
    const Basis basis{spread(axes.t), spread(axes.b), spread(axes.n)};
    for (size_t first = 0; first < count; first += 16) {
        const Vec3 local = square_to_cone(load_pairs(u + first, count - first), Float(height));
        store_vectors(normalize(from_local(basis, local)), count - first, directions + first);
    }
}

} // namespace relief::HWY_NAMESPACE::wide
HWY_AFTER_NAMESPACE();
