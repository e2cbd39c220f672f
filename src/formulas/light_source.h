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
const uint kSourceRectangle = 4u;
const uint kSourceDisk = 5u;
const uint kSourceSpot = 6u;

/// Members of 4 bytes, the same in device memory.
struct LightSourceData {
    uint kind;
    float power; ///< luminance scaled by estimate_irradiance
    Vec3 color;
    /// Sun: irradiance at normal incidence; others: radiant intensity, of flat lights and spots along their
    /// axis. Times `color`.
    float strength;
    Vec3 center;   ///< of the light, or of a sphere about all emitters
    float radius;  ///< of the disk, or of the sphere of a point or spot light; 0: a delta light
    float radius2; ///< of any sphere, squared; of flat lights: area / 2 pi
    Basis basis;   ///< about the direction towards the sun; about the way that flat lights and spots face
    float cone;    ///< 1 - cos of the half angle; 0: a delta light, if a sun
    float edge;    ///< of the spot: 1 - cos of the half angle from which on it fades, at most `cone`
    float half_width, half_height; ///< of the rectangle, along basis.t and basis.b
    uint is_visible;               ///< to camera rays
    uint texture;                  ///< of flat lights; kNone: none
    uint link;                     ///< first word of the set of instances that it lights; kNone: all
    uint group; ///< among those that a picture has layers of; else, and of emissive surfaces, none
};

/// A sampled direction towards a light with density `pdf` per solid angle; 0: no sample.
struct LightDraw {
    Vec3 direction; ///< unit length
    float distance; ///< infinity for the environment and suns
    Vec3 weight;    ///< radiance / pdf; irradiance for a delta light
    float pdf;      ///< infinity for a delta light
};

const float kSunDistance = 1e30f;

/// A light hit by a ray.
struct LightSeen {
    Vec3 radiance;  ///< zero: missed
    float pdf;      ///< density with which sampling would have chosen the direction
    float distance; ///< of the light met; of a sun kSunDistance
};

/// Whether an instance is in a set, by the word of the set that it belongs to: word `instance` / 32.
FN bool is_in_set(const uint word, const uint instance) { return ((word >> (instance & 31u)) & 1u) != 0u; }

/// Of a flat light; of the disc that a sphere looks like.
FN float shape_area(In(LightSourceData) source) {
    float rectangle = 4.0f * source.half_width * source.half_height;
    return source.kind == kSourceRectangle ? rectangle : kPi * source.radius * source.radius;
}

FN bool is_flat(In(LightSourceData) source) {
    return source.kind == kSourceRectangle || source.kind == kSourceDisk;
}

/// Part of its strength that a spot sends at an angle of 1 - cos = `height` to its axis.
FN float spot_falloff(In(LightSourceData) source, const float height) {
    float x = clamp((source.cone - height) / max(source.cone - source.edge, 1e-30f), 0.0f, 1.0f);
    return x * x * (3.0f - 2.0f * x);
}

/// Of light that travels against `direction`, the way in which the light is seen; 1 for other lights. All
/// points of a spot's sphere shine alike.
FN float direction_falloff(In(LightSourceData) source, const Vec3 direction) {
    // 1 - cos from the chord between the unit vectors, exact for small angles.
    Vec3 chord = direction + source.basis.n;
    return source.kind == kSourceSpot ? spot_falloff(source, 0.5f * dot(chord, chord)) : 1.0f;
}

/// The largest falloff over the sphere of a spot, whose centre is at `to`.
FN float largest_falloff(In(LightSourceData) source, const Vec3 to) {
    float distance = max(length(to), 1e-30f);
    Vec3 direction = to / distance;
    if (source.radius == 0.0f) return direction_falloff(source, direction);
    if (distance <= source.radius) return 1.0f;
    // The angle to the axis, less that of the sphere's radius.
    float sine = source.radius / distance;
    float cosine = sqrt(max(1.0f - sine * sine, 0.0f));
    float along = -dot(direction, source.basis.n);
    float across = sqrt(max(1.0f - along * along, 0.0f));
    return along >= cosine ? 1.0f : spot_falloff(source, 1.0f - (along * cosine + across * sine));
}

/// A point of a flat light, relative to its centre, nearest to a place given in its basis.
FN Vec3 nearest_on_light(In(LightSourceData) source, const Vec3 place) {
    float across = sqrt(place.x * place.x + place.y * place.y);
    float shrink = min(1.0f, source.radius / max(across, 1e-30f));
    Vec3 on_disk = {place.x * shrink, place.y * shrink, 0.0f};
    Vec3 on_rectangle = {clamp(place.x, -source.half_width, source.half_width),
                         clamp(place.y, -source.half_height, source.half_height), 0.0f};
    return source.kind == kSourceDisk ? on_disk : on_rectangle;
}

/// Radiance times about the solid angle of a flat light: like one of its area all at its nearest point, and
/// towards 2 pi where that is near. Rather too much, which costs samples, than far too little, which is
/// noise.
FN float estimate_flat_irradiance(In(LightSourceData) source, const Vec3 to) {
    Vec3 place = to_local(source.basis, to) * -1.0f;
    Vec3 away = place - nearest_on_light(source, place);
    float distance2 = dot(away, away);
    float cosine = place.z / max(sqrt(distance2), 1e-30f);
    return source.power * max(cosine, 0.0f) / max(distance2 + source.radius2, 1e-30f);
}

FN float estimate_irradiance(In(LightSourceData) source, const Vec3 position) {
    Vec3 to = source.center - position;
    if (is_flat(source)) return estimate_flat_irradiance(source, to);
    if (source.kind == kSourceSpot)
        return source.power * largest_falloff(source, to) / max(max(dot(to, to), source.radius2), 1e-30f);
    if (source.kind == kSourcePoint) return source.power / max(max(dot(to, to), source.radius2), 1e-30f);
    if (source.kind == kSourceEmitters) return source.power / max(dot(to, to) + source.radius2, 1e-30f);
    return source.power;
}

/// Radiance of a light with extent: a sun's disc, a sphere, a disk or a rectangle; of a spot along its axis.
FN Vec3 shape_radiance(In(LightSourceData) source) {
    // A disc of half angle a has projected solid angle pi sin(a)^2; sin^2 = h (2 - h), h = 1 - cos.
    float measure = source.kind == kSourceSun ? kPi * source.cone * (2.0f - source.cone) : shape_area(source);
    return source.color * (source.strength / measure);
}

FN LightDraw draw_sun(In(LightSourceData) source, const Vec2 u) {
    LightDraw drawn = {source.basis.n, make_infinity(), source.color * source.strength, make_infinity()};
    if (source.cone == 0.0f) return drawn;
    drawn.pdf = cone_pdf(source.cone);
    drawn.direction = normalize(from_local(source.basis, square_to_cone(u, source.cone)));
    drawn.weight = shape_radiance(source) * (1.0f / drawn.pdf);
    return drawn;
}

FN LightDraw draw_point_light(In(LightSourceData) source, const Vec3 position, const Vec2 u) {
    Vec3 to = source.center - position;
    float distance = length(to);
    LightDraw drawn = {to, distance, to, 0.0f};
    if (!(distance > 0.0f)) return drawn;
    Vec3 axis = to / distance;
    drawn.direction = axis;
    float cone = sphere_cone_height(source.radius, distance);
    // One so far away that its density is beyond all floats is a point too.
    if (cone < 1e-37f) {
        drawn.weight = source.color * (source.strength / (distance * distance));
        drawn.pdf = make_infinity();
        return drawn;
    }
    drawn.pdf = cone_pdf(cone);
    drawn.direction = normalize(from_local(make_basis(axis), square_to_cone(u, cone)));
    // Rounding may miss the sphere at its rim; use the distance of the tangent point then.
    float reach = sphere_distance(to, source.radius, drawn.direction);
    drawn.distance = reach <= 0.0f ? distance : reach;
    drawn.weight = shape_radiance(source) * (1.0f / drawn.pdf);
    return drawn;
}

FN LightDraw draw_spot_light(In(LightSourceData) source, const Vec3 position, const Vec2 u) {
    LightDraw drawn = draw_point_light(source, position, u);
    drawn.weight = drawn.weight * direction_falloff(source, drawn.direction);
    return drawn;
}

/// Density per solid angle of a point on a flat light of that area, from which the one that is lit lies
/// `facing` in front of its plane.
FN float flat_density(const float distance, const float facing, const float area) {
    float cube = distance * distance * distance;
    float divisor = facing * area;
    // Either is beyond all floats before the density is, of lights far away.
    bool is_plain = cube < 3.4e38f && divisor > 0.0f && divisor < 3.4e38f;
    return is_plain ? cube / divisor : (distance / facing) * ((distance / area) * distance);
}

/// By area. Density 0 behind the light, which shines to one side.
FN LightDraw draw_flat_light(In(LightSourceData) source, const Vec3 position, const Vec2 u) {
    Vec2 round = square_to_disk(u);
    bool is_disk = source.kind == kSourceDisk;
    float x = is_disk ? round.x * source.radius : (2.0f * u.x - 1.0f) * source.half_width;
    float y = is_disk ? round.y * source.radius : (2.0f * u.y - 1.0f) * source.half_height;
    Vec3 to = source.center - position + source.basis.t * x + source.basis.b * y;
    float distance = length(to);
    LightDraw drawn = {to, distance, to, 0.0f};
    float facing = -dot(to, source.basis.n);
    if (!(distance > 0.0f) || !(facing > 0.0f)) return drawn;
    drawn.direction = to / distance;
    drawn.pdf = flat_density(distance, facing, shape_area(source));
    drawn.weight = shape_radiance(source) * (1.0f / drawn.pdf);
    return drawn;
}

/// Of a light of the scene's list: neither the environment nor emissive surfaces.
FN LightDraw draw_listed_light(In(LightSourceData) source, const Vec3 position, const Vec2 u) {
    if (source.kind == kSourceSun) return draw_sun(source, u);
    if (source.kind == kSourceSpot) return draw_spot_light(source, position, u);
    if (source.kind == kSourcePoint) return draw_point_light(source, position, u);
    return draw_flat_light(source, position, u);
}

/// Density per solid angle, from a point `to` away, of a point on an emissive patch selected with
/// `probability`; `area_per_uv` and `normal` are those of its micro-triangle.
FN float emitter_density(const float probability, const float area_per_uv, const Vec3 normal, const Vec3 to) {
    float distance2 = dot(to, to);
    float cosine = abs(dot(normal, to)) / sqrt(distance2);
    if (!(cosine > 0.0f) || !(area_per_uv > 0.0f)) return 0.0f;
    return probability / area_per_uv * (distance2 / cosine);
}

/// The direction towards a point on an emissive patch, with that density.
FN LightDraw draw_emitter(const Vec3 emission, const Vec3 to, const float pdf) {
    float distance = length(to);
    LightDraw drawn = {to, distance, emission, 0.0f};
    if (!(distance > 0.0f) || !(pdf > 0.0f) || pdf == make_infinity()) return drawn;
    drawn.direction = to / distance;
    drawn.weight = emission * (1.0f / pdf);
    drawn.pdf = pdf;
    return drawn;
}

/// Place in the texture of a flat light of `size` texels, in which a ray from `origin` meets its plane; no
/// texel beyond the edge takes part.
FN Vec2 find_face_uv(In(LightSourceData) source, const Vec3 origin, const Vec3 direction, const Vec2 size) {
    Vec3 to = source.center - origin;
    float t = -dot(to, source.basis.n) / max(-dot(direction, source.basis.n), 1e-30f);
    Vec3 place = to_local(source.basis, direction * t - to);
    bool is_disk = source.kind == kSourceDisk;
    float u = 0.5f + 0.5f * place.x / (is_disk ? source.radius : source.half_width);
    float v = 0.5f + 0.5f * place.y / (is_disk ? source.radius : source.half_height);
    Vec2 uv = {clamp(u, 0.5f / size.x, 1.0f - 0.5f / size.x), clamp(v, 0.5f / size.y, 1.0f - 0.5f / size.y)};
    return uv;
}

/// Flat light that a ray hits within `distance`.
FN LightSeen meet_flat_light(In(LightSourceData) source, const Vec3 origin, const Vec3 direction,
                             const float distance) {
    Vec3 to = source.center - origin;
    float facing = -dot(direction, source.basis.n);
    float t = -dot(to, source.basis.n) / max(facing, 1e-30f);
    Vec3 place = to_local(source.basis, direction * t - to);
    bool is_on_disk = place.x * place.x + place.y * place.y <= source.radius * source.radius;
    bool is_on_rectangle = abs(place.x) <= source.half_width && abs(place.y) <= source.half_height;
    bool is_on = source.kind == kSourceDisk ? is_on_disk : is_on_rectangle;
    bool is_met = is_on && facing > 0.0f && t > 0.0f && t < distance;
    float pdf = t * t / (max(facing, 1e-30f) * shape_area(source));
    LightSeen seen = {shape_radiance(source) * (is_met ? 1.0f : 0.0f), is_met ? pdf : 0.0f,
                      is_met ? t : 0.0f};
    return seen;
}

/// Light of the scene's list that a ray hits within `distance`.
FN LightSeen meet_light(In(LightSourceData) source, const Vec3 origin, const Vec3 direction,
                        const float distance) {
    Vec3 zero = {0.0f, 0.0f, 0.0f};
    LightSeen seen = {zero, 0.0f, 0.0f};
    if (source.kind == kSourceSun && source.cone > 0.0f && distance == make_infinity()) {
        // 1 - cos from the chord between the unit vectors, exact for small angles.
        Vec3 chord = direction - source.basis.n;
        if (0.5f * dot(chord, chord) > source.cone) return seen;
        seen.radiance = shape_radiance(source);
        seen.pdf = cone_pdf(source.cone);
        seen.distance = kSunDistance;
    }
    if ((source.kind == kSourcePoint || source.kind == kSourceSpot) && source.radius > 0.0f) {
        Vec3 to = source.center - origin;
        float t = sphere_distance(to, source.radius, direction);
        if (!(t > 0.0f) || t >= distance) return seen;
        seen.distance = t;
        seen.radiance = shape_radiance(source) * direction_falloff(source, direction);
        seen.pdf = cone_pdf(sphere_cone_height(source.radius, length(to)));
    }
    if (is_flat(source)) return meet_flat_light(source, origin, direction, distance);
    return seen;
}

/// What a camera ray sees of a light of the scene's list within `distance`.
FN Vec3 see_light(In(LightSourceData) source, const Vec3 origin, const Vec3 direction, const float distance) {
    LightSeen seen = meet_light(source, origin, direction, distance);
    return seen.radiance * (source.is_visible != 0u ? 1.0f : 0.0f);
}

#include "formulas/end.h"
#endif
