// Formulas shared by all lights.
#ifndef RELIEF_LIGHT_H
#define RELIEF_LIGHT_H
#include "formulas/begin.h"

/// MIS weight of density a against b (Veach 1997, power heuristic, exponent 2); infinite a gives 1.
FN float power_heuristic(const float a, const float b) {
    float ratio = b / a;
    return a > 0.0f ? 1.0f / (1.0f + ratio * ratio) : 0.0f;
}

/// 1 - cos of the half angle that a sphere subtends; 2, all directions, from inside.
FN float sphere_cone_height(const float radius, const float distance) {
    float s = radius / distance;
    float s2 = s * s;
    // 1 - sqrt(1 - s2) without cancellation.
    return distance > radius ? s2 / (1.0f + sqrt(max(0.0f, 1.0f - s2))) : 2.0f;
}

/// Distance along the unit vector d from a point to a sphere whose centre is at `center` from it: where the
/// ray enters, or leaves from inside; negative for a miss.
FN float sphere_distance(const Vec3 center, const float radius, const Vec3 d) {
    float along = dot(center, d);
    Vec3 across = center - d * along;
    float half_chord2 = radius * radius - dot(across, across);
    float half_chord = sqrt(max(half_chord2, 0.0f));
    float t = along > half_chord ? along - half_chord : along + half_chord;
    return half_chord2 >= 0.0f ? t : -1.0f;
}

#include "formulas/end.h"
#endif
