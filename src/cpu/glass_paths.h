// What glass does to a path besides scattering: bodies that it is in take their part, and a surface that is
// partly glass is one or the other.
#pragma once

#include <cstdint>

#include "cpu/shading/point_material.h"
#include "prepare/material_glass.h"

namespace relief::cpu {

/// Where a path has come to.
struct GlassArrival {
    float height;   ///< of its direction over the surface, on the side of the winding: > 0 from within
    float distance; ///< that it came
    const scalar::GlassParameters* numbers; ///< that PointMaterial::glass_numbers refers to
};

/// Changes `material` to what the surface is here, and `u`, a random number in [0, 1), to another one. `body`
/// of solid glass that the path remembers (record of MaterialGlass; kNoIndex: none) becomes the one before
/// the surface. Returns a factor of the path.
Vec3f meet_glass(const MaterialGlass& glass, const GlassArrival& arrival, uint32_t& body,
                 PointMaterial& material, float& u);

/// The body that a ray leaves a vertex into; `body` lies before the surface, which is of `record` (kNoIndex:
/// no glass). `height` of the ray over the surface, on the side of the winding; `is_through`: it crosses it.
struct GlassDeparture {
    uint32_t body, record;
    float height;
    bool is_through;
};
uint32_t find_next_body(const MaterialGlass& glass, const GlassDeparture& departure);

} // namespace relief::cpu
