// Normals from maps in the tangent space of a displaced surface.
#ifndef RELIEF_NORMAL_MAP_H
#define RELIEF_NORMAL_MAP_H
#include "formulas/basis.h"

#include "formulas/begin.h"

/// Direction (t, b, n) that a texel means, not of unit length and never below the surface; `scale` of t and b
/// as in glTF 2.0 (3.9.3), negative for b where the map's +Y points against v.
FN Vec3 decode_normal(const Vec3 texel, const Vec2 scale) {
    Vec3 direction = {(2.0f * texel.x - 1.0f) * scale.x, (2.0f * texel.y - 1.0f) * scale.y,
                      max(2.0f * texel.z - 1.0f, 0.0f)};
    return direction;
}

/// `tangent` of a surface with normal `base`, turned as the shortest rotation from there to `normal` does;
/// unit vectors. A displaced surface may lean so far that a projection would turn its tangents round.
FN Vec3 turn_tangent(const Vec3 tangent, const Vec3 base, const Vec3 normal) {
    Vec3 level = tangent - base * dot(base, tangent);
    Vec3 turned = level - (base + normal) * (dot(normal, level) / max(1.0f + dot(base, normal), 1e-4f));
    Vec3 result = make_unit(turned - normal * dot(normal, turned));
    Vec3 zero = {0.0f, 0.0f, 0.0f};
    return select(result == zero, make_basis(normal).t, result);
}

/// The normal for `direction` (decode_normal) in the frame of `normal` and `tangent`, unit vectors at right
/// angles; `handedness`: -1 where growing v lies along -cross(normal, tangent), else 1.
FN Vec3 map_normal(const Vec3 normal, const Vec3 tangent, const float handedness, const Vec3 direction) {
    Vec3 bitangent = cross(normal, tangent) * handedness;
    Vec3 mapped = make_unit(tangent * direction.x + bitangent * direction.y + normal * direction.z);
    Vec3 zero = {0.0f, 0.0f, 0.0f};
    return select(mapped == zero, normal, mapped);
}

#include "formulas/end.h"
#endif
