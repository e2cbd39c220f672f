// Latitude-longitude environment light, importance-sampled piecewise constantly (PBRT 4, section 12.5.2).
#if !defined(RELIEF_ENVIRONMENT_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_ENVIRONMENT_H
#include "formulas/constants.h"
#include "formulas/environment_data.h"
#include "formulas/trig.h"
#endif
#include "formulas/begin.h"

/// Position in a latitude-longitude image, (0, 0) top left, of a unit vector: centre -z, up +y, right +x.
FN Vec2 direction_to_latlong(const Vec3 d) {
    Vec2 result = {Float(0.5f) + find_angle(d.x, Float(0.0f) - d.z) * Float(0.5f / kPi),
                   find_arc_cosine(clamp(d.y, Float(-1.0f), Float(1.0f))) * Float(1.0f / kPi)};
    return result;
}

FN Vec3 latlong_to_direction(const Vec2 p) {
    SinCos phi = find_sin_cos((p.x - Float(0.5f)) * Float(2.0f * kPi));
    SinCos theta = find_sin_cos(p.y * Float(kPi));
    Vec3 result = {theta.sine * phi.sine, theta.cosine, Float(0.0f) - theta.sine * phi.cosine};
    return result;
}

FN Vec3 turn_into_environment(const EnvironmentData e, const Vec3 d) {
    Float s = Float(e.sin_turn);
    Float c = Float(e.cos_turn);
    Vec3 result = {d.x * c - d.z * s, d.y, d.x * s + d.z * c};
    return result;
}

FN Vec3 turn_out_of_environment(const EnvironmentData e, const Vec3 d) {
    Float s = Float(e.sin_turn);
    Float c = Float(e.cos_turn);
    Vec3 result = {d.x * c + d.z * s, d.y, d.z * c - d.x * s};
    return result;
}

/// Position in the image for a world direction, with rotation.
FN Vec2 locate_in_environment(const EnvironmentData e, const Vec3 direction) {
    return direction_to_latlong(turn_into_environment(e, direction));
}

/// Position in [0, 1]^2 from the top left corner of the image, in texels from the centre of texel (0, 0).
FN Vec2 locate_latlong(const Vec2 position, const Vec2 size) {
    Vec2 result = {position.x * size.x - Float(0.5f), position.y * size.y - Float(0.5f)};
    return result;
}

/// Cell of `count` along an axis that holds a position in [0, 1], integer-valued; the first for NaN.
FN Float locate_environment_cell(const Float position, const Float count) {
    Float cell = floor(position * count);
    return select(cell > Float(0.0f), min(cell, count - Float(1.0f)), Float(0.0f));
}

/// Density per solid angle in a cell of the given probability; 0 at the poles, whose solid angle vanishes.
FN Float environment_cell_density(const EnvironmentData e, const Float probability, const Vec3 direction) {
    Float sine = sqrt(direction.x * direction.x + direction.z * direction.z);
    Bool is_pole = sine == Float(0.0f);
    float cells = float(e.cells_x * e.cells_y) * (0.5f / (kPi * kPi));
    return select(is_pole, Float(0.0f), probability * Float(cells) / select(is_pole, Float(1.0f), sine));
}

/// Position of u within the interval [low, high) of a cumulative distribution, in [0, 1).
FN Float locate_in_interval(const Float u, const Float low, const Float high) {
    Float width = high - low;
    Float position = (u - low) / max(width, Float(1e-37f));
    return select(width > Float(0.0f), min(position, Float(0.999999940395355224609375f)), Float(0.5f));
}

#include "formulas/end.h"
#endif
