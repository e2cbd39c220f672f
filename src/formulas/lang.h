// Common dialect of GLSL 4.60 and C++20 (docs/decisions/one-source-formulas.md). GLSL's names; C++ defines
// them elsewhere: FN In EXACT Float Bool Uint Vec2 Vec3 select is_any copy_sign is_finite make_unit.
#ifndef __cplusplus
#ifndef RELIEF_LANG_H
#define RELIEF_LANG_H
#define FN
#define In(Type) const Type
#define EXACT precise
#define Float float
#define Bool bool
#define Uint uint
#define Vec2 vec2
#define Vec3 vec3
#define select(condition, a, b) ((condition) ? (a) : (b))
#define is_any(condition) (condition)

float copy_sign(float size, float sign) {
    return uintBitsToFloat((floatBitsToUint(size) & 0x7fffffffu) | (floatBitsToUint(sign) & 0x80000000u));
}

bool is_finite(vec3 v) { return all(lessThanEqual(abs(v), vec3(3.402823466e38f))); }

/// Unit vector along a; (0, 0, 0) for a zero or non-finite vector, as normalize of math/vec.h. One way out:
/// behind a return within a branch the result would keep registers through loops around it.
vec3 make_unit(vec3 a) {
    precise float squared = a.x * a.x + a.y * a.y + a.z * a.z;
    vec3 result = vec3(0.0);
    if (squared > 1e-37 && squared < 3e38) {
        precise vec3 unit = a / sqrt(squared);
        result = unit;
    } else {
        float largest = max(abs(a.x), max(abs(a.y), abs(a.z)));
        if (largest > 0.0 && largest < 3e38) {
            precise vec3 scaled = a / largest;
            precise float length2 = scaled.x * scaled.x + scaled.y * scaled.y + scaled.z * scaled.z;
            precise vec3 tiny = scaled / sqrt(length2);
            result = tiny;
        }
    }
    return result;
}
#endif
#endif
