// Rays against the prepared scene on the CPU: the interface between shading and the SIMD kernels.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "engine/engine.h"
#include "formulas/camera.h"
#include "prepare/prepared_scene.h"
#include "relief/render.h"
#include "surface/patch/patch_samples.h"

namespace relief::cpu {

/// Of rays that end nowhere.
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct TraceRay {
    Vec3f origin{};
    float t_min = 0;
    Vec3f direction{};
    float t_max = kInfinity;
    uint32_t lod_bias = 0; ///< surface M_bias is seen: every level lowered by it
};

/// Where a ray hit the surface; `i`, `j`: the cell at the biased level, `is_upper`: triangle 00, 11, 01.
struct TraceHit {
    float t = kInfinity; ///< infinity: nothing
    uint32_t instance = kNoIndex;
    uint32_t patch = kNoIndex;
    float u = 0, v = 0; ///< on the patch, [0, 1]^2; on a triangle primitive likewise, with v <= u
    uint16_t i = 0, j = 0;
    uint8_t is_upper = 0;
    uint8_t lod_bias = 0;
    uint32_t levels = 0; ///< of the patch as this ray saw it: pack_levels (surface/patch/surface.h)
    bool is_hit() const { return instance != kNoIndex; }
};

/// A point of a surface, world space.
struct SurfacePoint {
    Vec3f position{};         ///< a few errors within the edges of its triangle: scalar::leave_edges
    Vec3f geometric_normal{}; ///< of the micro-triangle, unit length, side of the winding (not of the ray)
    Vec3f shading_normal{};   ///< unit length, same side as geometric_normal
    Vec2f uv{};               ///< texture coordinates; (0, 0) without
    float area_per_uv =
        0; ///< world area of the micro-triangle over its share of the patch's (u, v), which sum to 1
    float position_error =
        0; ///< how far rounding may have moved it off its triangle, and a ray that starts there
    uint32_t instance = kNoIndex;
    uint32_t patch = kNoIndex;
};

struct ShadingKernels;
class SceneWalk;
enum class OrderedQuery;

/// What one thread needs for many points at once.
struct PointScratch {
    PatchSamplesCache patches{128}; ///< rays of sixteen samples meet as many from time to time
    std::vector<uint64_t> keys, sorted;
    std::vector<uint8_t> kinds;
    std::vector<uint32_t> order;
};

/// Immutable but for `apply_changes`, `change_view`, `change_scene`, which are not thread safe, and the
/// caches of trees.
class Tracer {
  public:
    Tracer(std::shared_ptr<const PreparedScene> scene, const RenderSettings& settings);
    /// `walk` takes the place of the wide trees, unless it is null.
    Tracer(std::shared_ptr<const PreparedScene> scene, const RenderSettings& settings,
           std::unique_ptr<const SceneWalk> walk);
    ~Tracer();

    /// As Engine::apply_changes. Adds boxes of what changed, before and after, world space, to `places`.
    bool apply_changes(std::span<const SurfaceChange> changes, std::vector<Box>& places);

    /// As Engine::change_view.
    bool change_view(std::span<const SurfaceChange> changes, std::vector<Box>& places);

    /// As Engine::change_scene.
    bool change_scene(std::span<const SurfaceChange> changes);

    /// To be called between pictures, passes and spans of rays: makes boxes smaller where that pays by now.
    void rebuild_if_worthwhile() const;

    /// While this lives, rays end with StopRequest (base/stop_request.h) before the next tree
    /// that they need once `is_asked_for` is true: a ray at a high level may need many, each of which takes
    /// its time. Any worker asks. To be made and ended while nothing is traced.
    class StopScope {
      public:
        StopScope(const Tracer& tracer, std::function<bool()> is_asked_for);
        ~StopScope();
        StopScope(const StopScope&) = delete;
        StopScope& operator=(const StopScope&) = delete;

      private:
        const Tracer& tracer_;
    };

    /// The box of all that has a displacement, world space; empty where apply_changes() would be false. It
    /// may become smaller with rebuild_if_worthwhile().
    Box displaced_bounds() const;

    /// Nearest hit of each ray, in (t_min, t_max]. Rays that start together or go the same way are traced as
    /// bundles of 256 or packets of 16: give neighbours in such runs. `depth` says where the statistics count
    /// them: bounces behind the rays. Instances are met whose visibility mask shares a bit with `mask`.
    void closest_hits(std::span<const TraceRay> rays, std::span<TraceHit> hits, int depth = 0,
                      uint32_t mask = kVisibleToAll) const;
    /// The same, or any hit, of rays without an LOD bias, at most kOrderedRays, on the threads of the scope:
    /// each patch tree is built once for all of them (ordered_hits.h). False, and nothing is found, where the
    /// trees that they need fit into the cache, or rays are too few or need another traversal.
    bool ordered_hits(std::span<const TraceRay> rays, std::span<TraceHit> hits, OrderedQuery query,
                      uint32_t mask) const;
    /// False where ordered_hits of `count` rays is sure to be.
    bool may_order(size_t count) const;
    /// The same for further parts of rays that closest_hits has counted.
    void continued_hits(std::span<const TraceRay> rays, std::span<TraceHit> hits, int depth) const;

    /// Nearest hits of a pinhole camera at positions in pixels: bit-identical to closest_hits of the rays of
    /// scalar::make_pinhole_ray. Give neighbours in runs of 256. `rays` receives the rays unless it is empty.
    void camera_hits(const scalar::CameraFrame& camera, std::span<const Vec2f> positions,
                     std::span<TraceRay> rays, std::span<TraceHit> hits) const;

    /// occluded[i] = 1 where anything lies in (t_min, t_max], else 0. Counted as shadow rays.
    void any_hits(std::span<const TraceRay> rays, std::span<uint8_t> occluded, int depth = 0,
                  uint32_t mask = kVisibleToAll) const;

    /// All that shading needs to know of a hit.
    SurfacePoint make_surface_point(const TraceHit& hit) const;
    /// The same of many, none of which is a miss; points[k] belongs to hits[k].
    void make_surface_points(std::span<const TraceHit> hits, std::span<SurfacePoint> points,
                             PointScratch& scratch) const;

    /// Point (u, v) of a patch on surface M_bias, to sample lights. The shading normal is left out,
    /// the uv where no input of a material has a texture.
    SurfacePoint evaluate_point(uint32_t instance, uint32_t patch, Vec2f uv, uint32_t lod_bias) const;

    /// Origin for a ray that leaves `point` into `direction`: moved off the surface by point.position_error,
    /// along the geometric normal, to the side that the direction is on.
    Vec3f offset_origin(const SurfacePoint& point, const Vec3f& direction) const;

    void add_statistics(Statistics& statistics) const;
    /// Of the bytes of geometry and structures, what serves surfaces without displacement alone.
    size_t count_plain_bytes() const;

    const PreparedScene& scene() const { return *scene_; }
    const ShadingKernels& shading_kernels() const;

  private:
    struct Implementation;
    class Batch;
    void trace_closest(Batch& batch, std::span<const TraceRay> rays, std::span<TraceHit> hits) const;
    std::shared_ptr<const PreparedScene> scene_;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace relief::cpu
