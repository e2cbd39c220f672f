// The CPU engine taken apart for measurements: a scene made ready, its rays without shading, and its surface
// as grids of the very vertices that are traced. What a program uses is relief/intersect.h.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lab/trees.h"
#include "relief/intersect.h"

namespace relief {

/// Whether neighbouring rays may be traced as a packet. `single` is for surfaces without displacement alone.
enum class RayGrouping { single, packets };

/// Where a ray met the surface: all that is needed to go on from there.
struct ProbeHit {
    float t = std::numeric_limits<float>::infinity(); ///< infinity: nothing
    uint32_t instance = kNoIndex, patch = kNoIndex;
    Vec2f uv{};            ///< on the patch
    uint16_t i = 0, j = 0; ///< cell of the patch
    bool is_upper = false; ///< its second triangle (corners 00, 11, 01)
    bool is_hit() const { return instance != kNoIndex; }
};

struct ProbeRun {
    double seconds = 0; ///< from rays in memory, or from the camera, to hits in memory
    uint64_t hit_count = 0;
    std::vector<ProbeHit> hits;    ///< of closest hits
    std::vector<uint8_t> occluded; ///< of any hits
};

/// A point of the surface that rays leave from.
struct ProbePoint {
    Vec3f position{};
    Vec3f normal{};           ///< geometric, unit length, on the side of the winding
    float position_error = 0; ///< how far rounding may have moved it
};

/// Seconds from a scene in memory to the readiness for rays.
struct ProbePreparation {
    double surfaces_s = 0; ///< patches, bounds of the maps, levels
    double trees_s = 0;    ///< scene trees
    double seconds() const { return surfaces_s + trees_s; }
};

struct ProbeCounts {
    uint64_t patches = 0;     ///< displaced ones of all instances
    uint64_t micro_quads = 0; ///< of these at their levels
    uint64_t triangles = 0;   ///< of what is not displaced
    uint64_t geometry_bytes = 0, structures_bytes = 0;
    uint64_t plain_bytes = 0; ///< of these, what serves surfaces that are not displaced
    uint64_t trees_built = 0; ///< patch trees since the cache was emptied last
    uint64_t built_quads = 0; ///< micro-quads in them
    uint64_t built_bytes = 0; ///< bytes of them, whether kept or not
    uint64_t cache_bytes = 0; ///< the most that the cache has held, its table included
};

/// One thread at a time, but evaluate_patch is thread safe; tracing uses all of `settings.device.threads`.
class TracerProbe {
  public:
    /// Prepares the scene, by the clock. Throws Error as render() does.
    TracerProbe(Scene scene, const RenderSettings& settings);
    ~TracerProbe();

    const ProbePreparation& preparation() const;
    /// Builds the scene trees once more and forgets them; seconds.
    double measure_build() const;
    /// Starts anew with an empty cache of patch trees.
    void empty_cache();

    /// Rays through the middles of the picture's pixels in the order of packets: squares of 4 x 4 within
    /// tiles of 16 x 16. With an aperture each has a place on the lens of its own, always the same.
    std::vector<Ray> make_camera_rays(const Camera& camera) const;
    /// The scene's camera: the same rays in the same order as the engine's, making them by the clock. `room`:
    /// of an earlier run, its memory is used again.
    ProbeRun trace_camera(ProbeRun room = {}) const;
    ProbeRun trace(std::span<const Ray> rays, HitKind kind, RayGrouping grouping, ProbeRun room = {}) const;

    /// `hit` is one of this probe.
    ProbePoint find_point(const ProbeHit& hit) const;
    /// Corners of the triangle that was hit, world space.
    std::array<Vec3f, 3> find_corners(const ProbeHit& hit) const;
    /// The ray from a point, its origin moved off the surface as the engine does.
    Ray leave(const ProbePoint& point, const Vec3f& direction) const;

    /// Displaced patches of all instances are numbered one after another.
    uint32_t patch_count() const;
    int patch_level(uint32_t patch) const;
    /// All (2^level + 1)^2 vertices, row by row in u, world space: those that rays meet.
    void evaluate_patch(uint32_t patch, std::span<Vec3f> vertices) const;
    /// Corners of what is not displaced, world space.
    std::vector<std::array<Vec3f, 3>> list_plain_triangles() const;

    ProbeCounts count() const;
    std::string isa() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace relief
