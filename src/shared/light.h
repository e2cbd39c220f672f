// Formulas that lights and the surfaces under them share.
#ifndef RELIEF_LIGHT_H
#ifndef __cplusplus
#define RELIEF_LIGHT_H
#endif

/// Weight of the technique with density a beside one with density b (Veach 1997, power heuristic with
/// exponent 2). Infinite a (a delta light) gives 1.
FN float power_heuristic(float a, float b) {
    float ratio = b / a;
    return a > 0.0f ? 1.0f / (1.0f + ratio * ratio) : 0.0f;
}

/// Point of a latitude-longitude image, (0, 0) its top left corner, that is seen along a unit vector: the
/// middle looks along -z, up is +y, right is +x. Not turned.
FN Vec2 direction_to_latlong(Vec3 d) {
    Vec2 result = {0.5f + atan(d.x, -d.z) * (0.5f / kPi), acos(clamp(d.y, -1.0f, 1.0f)) * (1.0f / kPi)};
    return result;
}

FN Vec3 latlong_to_direction(Vec2 p) {
    float phi = (p.x - 0.5f) * (2.0f * kPi);
    float theta = p.y * kPi;
    Vec3 result = {sin(theta) * sin(phi), cos(theta), -sin(theta) * cos(phi)};
    return result;
}

/// 1 - cos of the half angle under which a sphere is seen; 2, every direction, from inside it.
FN float sphere_cone_height(float radius, float distance) {
    float s = radius / distance;
    float s2 = s * s;
    // 1 - sqrt(1 - s2) without cancellation.
    return distance > radius ? s2 / (1.0f + sqrt(max(0.0f, 1.0f - s2))) : 2.0f;
}

/// Distance along the unit vector d from a point to a sphere whose centre is at `center` from it: where the
/// ray enters, or leaves from inside; negative for a miss.
FN float sphere_distance(Vec3 center, float radius, Vec3 d) {
    float along = dot(center, d);
    Vec3 across = center - d * along;
    float half_chord2 = radius * radius - dot(across, across);
    float half_chord = sqrt(max(half_chord2, 0.0f));
    float t = along > half_chord ? along - half_chord : along + half_chord;
    return half_chord2 >= 0.0f ? t : -1.0f;
}

/// Shading normal turned just so far that the mirror image of `wo` stays above the geometric surface: no
/// black pixels at grazing triangles. Both normals on the side of `wo`; unit vectors.
FN Vec3 bend_normal(Vec3 shading, Vec3 geometric, Vec3 wo) {
    Vec3 mirrored = shading * (2.0f * dot(wo, shading)) - wo;
    float lowest = min(0.9f * dot(wo, geometric), 0.01f);
    float height = dot(mirrored, geometric);
    if (height >= lowest) return shading;
    Vec3 lifted = normalize(mirrored + geometric * (lowest - height));
    return normalize(lifted + wo);
}

#endif
