// Path tracer conventions of both engines: sample dimensions, camera rays, Russian roulette.
#ifndef RELIEF_PATH_H
#define RELIEF_PATH_H
#include "formulas/camera.h"
#include "formulas/sobol.h"

#include "formulas/begin.h"

const uint kRouletteDepth = 1u;       ///< bounces exempt from Russian roulette
const float kLeastThroughput = 0.25f; ///< of paths that it spares

// Dimension pairs of the sampler.
const uint kPixelPair = 0u;
const uint kLensPair = 1u;
const uint kFirstBouncePair = 2u;
const uint kPairsPerBounce = 4u;
const uint kPickPair = 0u; ///< (light, lobe)
const uint kLightPair = 1u;
const uint kBsdfPair = 2u;
const uint kRoulettePair = 3u; ///< (roulette, emitter)

/// Dimension pair `kind` of the vertex after `depth` bounces.
FN uint find_bounce_pair(const uint depth, const uint kind) {
    return kFirstBouncePair + depth * kPairsPerBounce + kind;
}

FN Vec2 draw_bounce_pair(const uint pixel_seed, const uint sample_index, const uint depth, const uint kind) {
    return sobol_pair(pixel_seed, sample_index, find_bounce_pair(depth, kind));
}

/// In [0, 1): decides whether a ray passes the cut-out that it meets after `round` others. `is_shadow`: the
/// shadow ray of the vertex after `depth` bounces, else the ray that comes there.
FN float draw_cut_out(const uint pixel_seed, const uint sample_index, const uint depth, const uint is_shadow,
                      const uint round) {
    const uint first_pair = 65536u; // behind those of all bounces
    return sobol_pair(pixel_seed, sample_index, first_pair + (2u * depth + is_shadow) * 256u + round).x;
}

/// Ray through a point of the picture, in pixels.
FN CameraRay aim_camera_ray(const CameraFrame camera, const Vec2 position, const uint pixel_seed,
                            const uint sample_index) {
    if (camera.aperture_radius > 0.0f)
        return make_camera_ray(camera, position, sobol_pair(pixel_seed, sample_index, kLensPair));
    return make_pinhole_ray(camera, position);
}

/// Ray through a random point of the pixel with the given top left corner.
FN CameraRay start_camera_ray(const CameraFrame camera, const Vec2 corner, const uint pixel_seed,
                              const uint sample_index) {
    Vec2 position = corner + sobol_pair(pixel_seed, sample_index, kPixelPair);
    return aim_camera_ray(camera, position, pixel_seed, sample_index);
}

/// Clamps a base colour after multiplication by textures.
FN Vec3 limit_color(const Vec3 color) {
    Vec3 zero = {0.0f, 0.0f, 0.0f};
    Vec3 one = {1.0f, 1.0f, 1.0f};
    return max(zero, min(color, one));
}

/// The factor that clamp_indirect multiplies light by.
FN float find_clamp_scale(const Vec3 light, const float limit, const uint bounces) {
    float sum = light.x + light.y + light.z;
    return limit > 0.0f && bounces > 0u && sum > 3.0f * limit ? 3.0f * limit / sum : 1.0f;
}

/// Light that arrives after so many bounces, scaled so that the mean of its components is at most `limit`; 0:
/// no limit. The rule is that of Blender's Cycles. It is biased: the light above the limit is lost.
FN Vec3 clamp_indirect(const Vec3 light, const float limit, const uint bounces) {
    return light * find_clamp_scale(light, limit, bounces);
}

/// Depth of the last rays of paths of so many bounces: behind the last vertex one more looks for light alone,
/// so that there, too, lights found and lights drawn are weighed. Direct light alone is one shadow ray.
FN uint find_last_depth(const uint bounces) { return bounces > 0u ? bounces + 1u : 0u; }

/// Russian roulette (Arvo and Kirk 1990), from the second vertex on. Paths that carry kLeastThroughput or
/// more all go on: ending them costs more in noise than it saves in rays (docs/results/noise.md).
FN float survival_probability(const uint depth, const Vec3 throughput) {
    float brightest = max(max(throughput.x, throughput.y), throughput.z);
    return depth < kRouletteDepth ? 1.0f : min(brightest * (1.0f / kLeastThroughput), 1.0f);
}

#include "formulas/end.h"
#endif
