// Path state on a device, between the kernels of one depth. Path p has ray p; its shadow ray is ray capacity
// + p. Scalar block layout, members of 4 bytes.
#ifndef RELIEF_DEVICE_PATHS_H
#define RELIEF_DEVICE_PATHS_H
#include "formulas/bounce_lod.h"
#include "formulas/camera.h"
#include "formulas/environment_data.h"

#include "formulas/begin.h"

/// One sample of one pixel.
struct PathData {
    Vec3 throughput;
    float bsdf_pdf; ///< density with which its ray was sampled
    Vec3 previous;  ///< the vertex that the ray started at
    uint pixel_seed;
    Vec3 radiance;
    float cost;        ///< rays so far
    Vec3 contribution; ///< of its shadow ray, if unoccluded
    Vec3 normal;       ///< at `previous`, of the side that the ray left to; where there is a light tree
    uint instance;     ///< that `previous` is on; where lights are linked
    uint body;         ///< of solid glass that its ray is in: a material; kNone: none
    /// Of a shadow ray that starts above its triangle (terminator.glsl): until it is known that nothing is
    /// in the way up there, its ray is that way. Distance 0: of all others.
    Vec3 lifted_direction;
    float lifted_distance;
};

/// A surface point for shading, world space; normals on the viewer's side.
struct SurfacePointData {
    Vec3 position;
    float position_error;
    Vec3 geometric_normal;
    float area_per_uv;
    Vec3 bent_normal; ///< shading normal, bent (bend_normal)
    float roughness;
    Vec3 base_color;
    float metallic;
    uint is_flipped; ///< the viewer is on the side opposite to the winding
};

const uint kSurfacePointWords = 17u; ///< of SurfacePointData

/// Sums over the samples of one pixel in one launch. All but radiance, squares, cost and shadow refer to
/// first hits.
struct FilmSumsData {
    Vec3 radiance;
    Vec3 squares; ///< of radiance
    float cost;
    float hit_count;
    float light_count; ///< of samples that hit nothing, but met a light that they see
    Vec3 shading_normal, geometric_normal, position, albedo;
    Vec3 shadow; ///< of FilmSample
    Vec2 uv;
    float depth; ///< minimum
    uint id;     ///< of the nearest hit: 1 + instance, the lowest among ties; 0: no hit
};

const uint kFilmSumsWords = 28u; ///< of FilmSumsData

/// What FilmSumsData begins with.
struct FilmColorsData {
    Vec3 radiance, squares;
    float cost, hit_count, light_count;
};

const uint kFilmColorsWords = 9u; ///< of FilmColorsData

struct FilmColorsPush {
    uint word_count; ///< of all pixels
};

/// Of a path, in the film's buffer behind all sums of light: LightShares of the light that was drawn at its
/// first vertex and of what comes there; the group of the light that was drawn last; whether its guides are
/// found.
const uint kPathLightWords = 10u;

/// Emissive patch `index`: cumulative probability in units of 2^-24, as fine as random numbers.
struct EmitterData {
    uint end;
    uint probability; ///< bits of a float; where there is a light tree, its leaf
};

const float kEmitterParts = 16777216.0f;

/// A pixel of the picture in the list of pixels (the list of shadow rays, when a sample begins); coordinates
/// below 2^16.
FN uint pack_pixel(uint x, uint y) { return y << 16 | x; }

/// Path k belongs to pixel k of the list. Where they are drawn they are also pixels [first_pixel, first_pixel
/// + count) of a window in the order of place_pixel.
struct CameraPush {
    CameraFrame camera;
    uint x0, y0, width, height;
    uint first_pixel, count;
    uint sample_index, seed;
};

/// Push constants of the kernel that lists the rays which pass cut-outs.
struct CutOutPush {
    uint count;    ///< of the path list; of shadow rays
    uint capacity; ///< of paths
    uint depth;
    uint is_shadow; ///< rays of the shadow list; what passes comes into the path list
    uint sample_index;
    uint round;                          ///< cut-outs that all of them have passed
    uint source_count, first_light_node; ///< as in PathPush
    float clamp_indirect;
};

/// Push constants of the other kernels of a depth.
struct PathPush {
    uint count; ///< of the path list, shadow rays or pixels
    uint capacity;
    uint depth, last_depth;
    float clamp_indirect; ///< 0: none
    uint sample_index;
    uint source_count;     ///< listed ones (prepare/light_sources.h)
    uint first_light_node; ///< of the light tree behind all sources; 0: none
    uint emitter_count, emitter_range_count;
    uint has_environment;
    uint has_background; ///< camera rays see `background` in place of the environment
    Vec3 background;
    EnvironmentData environment;
    BounceLod bounce_lod;
    /// Word of the film's buffer, behind all else, from which on a sample notes its first hits: one a path,
    /// 1 + instance. 0: they are not asked for.
    uint first_hit_offset;
};

#include "formulas/end.h"
#endif
