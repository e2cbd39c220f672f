// Frames about a direction, and vectors in them.
#if !defined(RELIEF_BASIS_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_BASIS_H
#endif
#include "formulas/begin.h"

/// Orthonormal right-handed frame.
struct Basis {
    Vec3 t, b, n;
};

/// Frame about a unit vector without a singularity (Duff et al. 2017, Building an Orthonormal Basis).
FN Basis make_basis(const Vec3 n) {
    Float sign = select(n.z < Float(0.0f), Float(-1.0f), Float(1.0f));
    Float a = Float(-1.0f) / (sign + n.z);
    Float b = n.x * n.y * a;
    Vec3 t = {Float(1.0f) + sign * n.x * n.x * a, sign * b, Float(0.0f) - sign * n.x};
    Vec3 bitangent = {b, sign + n.y * n.y * a, Float(0.0f) - n.y};
    Basis result = {t, bitangent, n};
    return result;
}

/// Frame about a unit vector `n` whose t goes along `tangent`, of any length, as far as it can.
FN Basis make_basis_along(const Vec3 n, const Vec3 tangent) {
    Basis result = make_basis(n);
    Vec3 level = tangent - n * dot(n, tangent);
    Bool is_level = dot(level, level) > Float(1e-8f) * dot(tangent, tangent);
    result.t = select(is_level, make_unit(level), result.t);
    result.b = cross(n, result.t);
    return result;
}

FN Vec3 to_local(const Basis basis, const Vec3 v) {
    Vec3 result = {dot(v, basis.t), dot(v, basis.b), dot(v, basis.n)};
    return result;
}

FN Vec3 from_local(const Basis basis, const Vec3 v) { return basis.t * v.x + basis.b * v.y + basis.n * v.z; }

#include "formulas/end.h"
#endif
