// The common dialect of GLSL 4.60 and C++20 (see docs/decisions/one-source-formulas.md). For GLSL this file
// defines the names; C++ instances define them before the include: FN EXACT Float Bool Uint Vec2 Vec3 select
// is_finite normalize_or_zero.
#ifndef __cplusplus
#ifndef RELIEF_LANG_H
#define RELIEF_LANG_H
#define FN
#define EXACT precise
#define Float float
#define Bool bool
#define Uint uint
#define Vec2 vec2
#define Vec3 vec3
#define select(condition, a, b) ((condition) ? (a) : (b))

bool is_finite(vec3 v) { return all(lessThanEqual(abs(v), vec3(3.402823466e38f))); }

/// Unit vector along v; (0, 0, 0) for a zero or non-finite vector, as normalize of math/vec.h gives.
vec3 normalize_or_zero(vec3 v) {
    float largest = max(max(abs(v.x), abs(v.y)), abs(v.z));
    if (!(largest > 0.0f) || !is_finite(v)) return vec3(0.0f);
    return normalize(v / largest);
}
#endif
#endif
