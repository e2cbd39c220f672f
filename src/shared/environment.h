// The environment as a light: a latitude-longitude image, directions drawn by brightness from a piecewise
// constant density over cells of latitude and longitude (Pharr, Jakob and Humphreys 2023, Physically Based
// Rendering, section 12.5.2).
#ifndef RELIEF_ENVIRONMENT_H
#ifndef __cplusplus
#define RELIEF_ENVIRONMENT_H
#endif

/// Members of 4 bytes: part of the kernels' push constants.
struct EnvironmentData {
    Vec3 scale;               ///< on the image; without one the radiance
    float sin_turn, cos_turn; ///< about +y
    uint cells_x, cells_y;    ///< of the density
    uint texture_index;       ///< kNone: constant
};

FN Vec3 turn_into_environment(EnvironmentData e, Vec3 d) {
    Vec3 result = {d.x * e.cos_turn - d.z * e.sin_turn, d.y, d.x * e.sin_turn + d.z * e.cos_turn};
    return result;
}

FN Vec3 turn_out_of_environment(EnvironmentData e, Vec3 d) {
    Vec3 result = {d.x * e.cos_turn + d.z * e.sin_turn, d.y, d.z * e.cos_turn - d.x * e.sin_turn};
    return result;
}

/// Point of the image that is seen along a world direction.
FN Vec2 locate_in_environment(EnvironmentData e, Vec3 direction) {
    return direction_to_latlong(turn_into_environment(e, direction));
}

/// Cell of `count` along one axis.
FN uint locate_environment_cell(float position, uint count) {
    uint cell = uint(position * float(count));
    return select(cell < count, cell, count - 1u);
}

/// Density per solid angle of a direction in a cell of the given probability; 0 at the poles, which have no
/// measure.
FN float environment_cell_density(EnvironmentData e, float probability, Vec3 direction) {
    float sine = sqrt(direction.x * direction.x + direction.z * direction.z);
    return sine > 0.0f ? probability * float(e.cells_x * e.cells_y) / (2.0f * kPi * kPi * sine) : 0.0f;
}

/// Position of u within the interval [low, high) of a cumulative distribution, in [0, 1).
FN float locate_in_interval(float u, float low, float high) {
    float width = high - low;
    float position = width > 0.0f ? (u - low) / width : 0.5f;
    return min(position, 0.999999940395355224609375f);
}

#endif
