// Light sources: estimated irradiance at a point, and sampling of directions towards them.
#ifndef RELIEF_LIGHT_SOURCE_H
#define RELIEF_LIGHT_SOURCE_H
#include "formulas/basis.h"
#include "formulas/constants.h"
#include "formulas/light.h"
#include "formulas/warp.h"

#include "formulas/begin.h"

const uint kSourceEnvironment = 0u;
const uint kSourceSun = 1u;
const uint kSourcePoint = 2u;
const uint kSourceEmitters = 3u; ///< all emissive surfaces together

/// Members of 4 bytes, the same in device memory.
struct LightSourceData {
    uint kind;
    float power; ///< luminance scaled by estimate_irradiance
    Vec3 color;
    float strength; ///< sun: irradiance at normal incidence; point: radiant intensity; both times `color`
    Vec3 center;    ///< of the point light, or of a sphere about all emitters
    float radius;   ///< of the point light's sphere; 0: a delta light
    float radius2;  ///< of either sphere, squared
    Basis basis;    ///< about the direction towards the sun
    float cone;     ///< of the sun: 1 - cos of the half angle; 0: a delta light
};

/// A sampled direction towards a light with density `pdf` per solid angle; 0: no sample.
struct LightDraw {
    Vec3 direction; ///< unit length
    float distance; ///< infinity for the environment and suns
    Vec3 weight;    ///< radiance / pdf; irradiance for a delta light
    float pdf;      ///< infinity for a delta light
};

/// A light hit by a ray.
struct LightSeen {
    Vec3 radiance; ///< zero: missed
    float pdf;     ///< density with which sampling would have chosen the direction
};

FN float estimate_irradiance(LightSourceData source, Vec3 position) {
    Vec3 to = source.center - position;
    if (source.kind == kSourcePoint) return source.power / max(max(dot(to, to), source.radius2), 1e-30f);
    if (source.kind == kSourceEmitters) return source.power / max(dot(to, to) + source.radius2, 1e-30f);
    return source.power;
}

/// Radiance of a light with extent: a sun's disc, or the sphere of a point light.
FN Vec3 shape_radiance(LightSourceData source) {
    // A disc of half angle a has projected solid angle pi sin(a)^2; sin^2 = h (2 - h), h = 1 - cos.
    float measure = source.kind == kSourceSun ? kPi * source.cone * (2.0f - source.cone)
                                              : kPi * source.radius * source.radius;
    return source.color * (source.strength / measure);
}

FN LightDraw draw_sun(LightSourceData source, Vec2 u) {
    LightDraw drawn = {source.basis.n, make_infinity(), source.color * source.strength, make_infinity()};
    if (source.cone == 0.0f) return drawn;
    drawn.pdf = cone_pdf(source.cone);
    drawn.direction = normalize(from_local(source.basis, square_to_cone(u, source.cone)));
    drawn.weight = shape_radiance(source) * (1.0f / drawn.pdf);
    return drawn;
}

FN LightDraw draw_point_light(LightSourceData source, Vec3 position, Vec2 u) {
    Vec3 to = source.center - position;
    float distance = length(to);
    LightDraw drawn = {to, distance, to, 0.0f};
    if (!(distance > 0.0f)) return drawn;
    Vec3 axis = to / distance;
    drawn.direction = axis;
    if (source.radius == 0.0f) {
        drawn.weight = source.color * (source.strength / (distance * distance));
        drawn.pdf = make_infinity();
        return drawn;
    }
    float cone = sphere_cone_height(source.radius, distance);
    drawn.pdf = cone_pdf(cone);
    drawn.direction = normalize(from_local(make_basis(axis), square_to_cone(u, cone)));
    // Rounding may miss the sphere at its rim; use the distance of the tangent point then.
    float reach = sphere_distance(to, source.radius, drawn.direction);
    drawn.distance = reach <= 0.0f ? distance : reach;
    drawn.weight = shape_radiance(source) * (1.0f / drawn.pdf);
    return drawn;
}

/// Density per solid angle, from a point `to` away, of a point on an emissive patch selected with
/// `probability`; `area_per_uv` and `normal` are those of its micro-triangle.
FN float emitter_density(float probability, float area_per_uv, Vec3 normal, Vec3 to) {
    float distance2 = dot(to, to);
    float cosine = abs(dot(normal, to)) / sqrt(distance2);
    if (!(cosine > 0.0f) || !(area_per_uv > 0.0f)) return 0.0f;
    return probability / area_per_uv * (distance2 / cosine);
}

/// The direction towards a point on an emissive patch, with that density.
FN LightDraw draw_emitter(Vec3 emission, Vec3 to, float pdf) {
    float distance = length(to);
    LightDraw drawn = {to, distance, emission, 0.0f};
    if (!(distance > 0.0f) || !(pdf > 0.0f) || pdf == make_infinity()) return drawn;
    drawn.direction = to / distance;
    drawn.weight = emission * (1.0f / pdf);
    drawn.pdf = pdf;
    return drawn;
}

/// Sun or point light that a ray hits within `distance`.
FN LightSeen meet_light(LightSourceData source, Vec3 origin, Vec3 direction, float distance) {
    Vec3 zero = {0.0f, 0.0f, 0.0f};
    LightSeen seen = {zero, 0.0f};
    if (source.kind == kSourceSun && source.cone > 0.0f && distance == make_infinity()) {
        // 1 - cos from the chord between the unit vectors, exact for small angles.
        Vec3 chord = direction - source.basis.n;
        if (0.5f * dot(chord, chord) > source.cone) return seen;
        seen.radiance = shape_radiance(source);
        seen.pdf = cone_pdf(source.cone);
    }
    if (source.kind == kSourcePoint && source.radius > 0.0f) {
        Vec3 to = source.center - origin;
        float t = sphere_distance(to, source.radius, direction);
        if (!(t > 0.0f) || t >= distance) return seen;
        seen.radiance = shape_radiance(source);
        seen.pdf = cone_pdf(sphere_cone_height(source.radius, length(to)));
    }
    return seen;
}

#include "formulas/end.h"
#endif
