#include "cpu/tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "base/check.h"
#include "base/parallel.h"
#include "base/timer.h"
#include "cpu/ordered_hits.h"
#include "cpu/scene_trees.h"
#include "cpu/shading/surface_points.h"
#include "cpu/traversal/kernels.h"
#include "cpu/traversal/scene_walk.h"
#include "formulas/camera.h"
#include "formulas/surface_point.h"
#include "relief/error.h"

namespace relief::cpu {

namespace {

/// One batch of a kind in so many is timed inside of patches; the clock would cost too much in all.
constexpr uint64_t kTimedBatchInterval = 32;

/// Of the memory for trees so much is lost around them and in between.
constexpr size_t kLostShare = 8;

/// With fewer rays, or less room for trees, the order of rays is not worth its time.
constexpr size_t kLeastOrdered = 4096, kLeastOrderedRoom = size_t(4) << 20;

size_t count_bytes(const Instance& instance) {
    const size_t lines = instance.lines ? instance.lines->size() * sizeof(PatchLines) : 0;
    return sizeof(Instance) + instance.levels->byte_count() + lines;
}

CacheLimits make_limits(const SurfaceSettings& settings, const PreparedScene& scene) {
    CacheLimits limits{kDefaultCacheBytes, std::numeric_limits<size_t>::max()};
    if (settings.cache_bytes) limits = {*settings.cache_bytes, *settings.cache_bytes};
    for (const Surface& surface : scene.surfaces)
        if (surface.has_displacement) limits.patch_count += surface.quads.size();
    return limits;
}

} // namespace

struct Tracer::Implementation {
    const Kernels* kernels = nullptr;
    const ShadingKernels* shading = nullptr;
    std::unique_ptr<const SceneWalk> walk; ///< of a traversal chosen by name; null: the wide trees
    std::vector<PolygonTree> polygon_trees;
    std::unique_ptr<PatchTreeCache> cache;
    SceneView view;                         ///< but for the scene trees
    std::unique_ptr<SceneTreeHolder> trees; ///< null: those of a walk requested by name
    size_t most_tree_bytes = 0;
    float pixel_error = 1;

    void make_trees(const PreparedScene& scene) {
        if (walk) return;
        for (const Surface& surface : scene.surfaces)
            polygon_trees.push_back(surface.has_displacement ? PolygonTree{} : build_polygon_tree(surface));
        trees = std::make_unique<SceneTreeHolder>(scene, *kernels, polygon_trees);
    }

    /// Takes where the scene's lists are.
    void follow_lists(const PreparedScene& scene) {
        view.instances = scene.instances.data();
        view.surfaces = scene.surfaces.data();
        view.instance_count = uint32_t(scene.instances.size());
        view.polygon_trees = polygon_trees.data();
    }

    void remove_changed(std::span<const SurfaceChange> changes) {
        cache->remove([&](const TreeKey& key) {
            return std::any_of(changes.begin(), changes.end(), [&](const SurfaceChange& change) {
                return key.surface == change.surface && (change.is_replaced || change.is_changed[key.patch]);
            });
        });
    }

    /// An only instance is entered without a look at its mask.
    bool is_hidden(uint32_t mask) const {
        return view.instance_count == 1 && (view.instances[0].visibility_mask & mask) == 0;
    }

    /// Takes what the camera and the sizes of objects decide from the scene.
    void follow_camera(const PreparedScene& scene) {
        const float pixel =
            float(2 * std::tan(scene.camera.fov_degrees * std::numbers::pi / 360) / scene.height);
        view.pixel_angle = pixel_error * pixel;
        constexpr float kNarrow = 0.125f; // of the largest object's radius
        view.narrow = 0;
        for (const Instance& instance : scene.instances)
            if (scene.surfaces[instance.surface].has_displacement)
                view.narrow = std::max(view.narrow, kNarrow * instance.reach);
        find_most_tree_bytes();
    }

    /// Of the trees of all patches, if those of an instance all had its finest level.
    void find_most_tree_bytes() {
        most_tree_bytes = 0;
        for (size_t k = 0; k < view.instance_count; ++k) {
            const Surface& surface = view.surfaces[view.instances[k].surface];
            if (surface.has_displacement)
                most_tree_bytes +=
                    surface.quads.size() * count_tree_bytes(uint32_t(view.instances[k].levels->max_level()));
        }
        most_tree_bytes += most_tree_bytes / kLostShare;
    }

    void add_casts(Statistics& statistics) const {
        const std::vector<CastCounters> casts = cache->sum_casts();
        for (size_t k = 0; k < casts.size(); ++k) {
            const CastCounters& c = casts[k];
            if (c.rays == 0) continue;
            const double share = c.sampled_trace_s > 0 ? c.sampled_bottom_s / c.sampled_trace_s : 0;
            const CastStatistics cast{
                int(k / 2), k % 2 == 1,       c.rays,           c.pairs, c.trace_s * (1 - share),
                0,          c.bottom_build_s, c.trace_s * share};
            statistics.casts.push_back(cast);
            statistics.top_traversal_s += cast.top_traversal_s;
            statistics.bottom_build_s += cast.bottom_build_s;
            statistics.bottom_traversal_s += cast.bottom_traversal_s;
        }
    }
};

/// One batch of rays: the context of a worker, the scene with its trees as they are now, and the clock.
class Tracer::Batch {
  public:
    /// `cast` is the place in TraceContext::casts.
    Batch(const Implementation& tracer, size_t cast, size_t rays, uint32_t mask = kVisibleToAll)
        : view(tracer.view), context(tracer.cache->acquire()), tracer_(tracer), cast_(cast), rays_(rays) {
        if (tracer.trees) {
            trees_ = tracer.trees->current();
            view.surface_trees = trees_->surfaces.data();
            view.instance_tree = &trees_->instances;
        }
        view.visibility_mask = mask;
        if (context.casts.size() <= cast) context.casts.resize(cast + 1);
        context.is_timed = context.casts[cast].batches % kTimedBatchInterval == 0;
        before_ = context.counters;
        timer_.restart();
    }
    ~Batch() {
        const double built = context.counters.bottom_build_s - before_.bottom_build_s;
        const double seconds = timer_.seconds() - built;
        context.casts[cast_].add({1, rays_, context.counters.pairs_emitted - before_.pairs_emitted, built,
                                  seconds, context.is_timed ? seconds : 0,
                                  context.counters.sampled_bottom_s - before_.sampled_bottom_s});
        tracer_.cache->release(context);
        if (tracer_.trees) tracer_.trees->count_rays(rays_);
    }
    Batch(const Batch&) = delete;
    Batch& operator=(const Batch&) = delete;

    SceneView view;
    TraceContext& context;

  private:
    const Implementation& tracer_;
    std::shared_ptr<const SceneTrees> trees_;
    size_t cast_, rays_;
    TraceCounters before_;
    Timer timer_;
};

Tracer::Tracer(std::shared_ptr<const PreparedScene> scene, const RenderSettings& settings)
    : Tracer(std::move(scene), settings, nullptr) {}

Tracer::Tracer(std::shared_ptr<const PreparedScene> scene, const RenderSettings& settings,
               std::unique_ptr<const SceneWalk> walk)
    : scene_(std::move(scene)), implementation_(std::make_unique<Implementation>()) {
    Implementation& self = *implementation_;
    self.kernels = find_kernels(settings.device.isa);
    if (!self.kernels)
        throw Error(ErrorKind::device_missing, {"this machine or build lacks the instruction set requested",
                                                "", "available_isas() lists those that work"});
    self.shading = &find_shading_kernels(self.kernels->name);
    self.walk = std::move(walk);
    self.make_trees(*scene_);
    self.cache =
        std::make_unique<PatchTreeCache>(make_limits(settings.surface, *scene_), self.kernels->build_tree);
    self.follow_lists(*scene_);
    self.view.cache = self.cache.get();
    self.view.leaf = settings.surface.leaf, self.view.lod = settings.surface.lod;
    self.pixel_error = settings.surface.pixel_error;
    self.follow_camera(*scene_);
}

Tracer::~Tracer() = default;

void Tracer::rebuild_if_worthwhile() const {
    if (implementation_->trees) implementation_->trees->rebuild_if_worthwhile();
}

Tracer::StopScope::StopScope(const Tracer& tracer, std::function<bool()> is_asked_for) : tracer_(tracer) {
    tracer_.implementation_->cache->set_stop(std::move(is_asked_for));
}
Tracer::StopScope::~StopScope() { tracer_.implementation_->cache->set_stop({}); }

Box Tracer::displaced_bounds() const {
    const Implementation& self = *implementation_;
    Box bounds;
    if (!self.trees) return bounds;
    const std::shared_ptr<const SceneTrees> trees = self.trees->current();
    for (const Instance& instance : scene_->instances)
        if (scene_->surfaces[instance.surface].has_displacement)
            bounds.extend(
                transform_box(instance.world_from_object, trees->surfaces[instance.surface].bounds));
    return bounds;
}

bool Tracer::apply_changes(std::span<const SurfaceChange> changes, std::vector<Box>& places) {
    Implementation& self = *implementation_;
    if (!self.trees) return false;
    self.trees->apply_changes(changes, places);
    self.find_most_tree_bytes();
    self.remove_changed(changes);
    return true;
}

bool Tracer::change_view(std::span<const SurfaceChange> changes, std::vector<Box>& places) {
    Implementation& self = *implementation_;
    if (!self.trees) return false;
    self.trees->follow_levels();
    self.follow_camera(*scene_);
    return apply_changes(changes, places);
}

bool Tracer::change_scene(std::span<const SurfaceChange> changes) {
    Implementation& self = *implementation_;
    if (!self.trees) return false;
    self.follow_lists(*scene_);
    for (const SurfaceChange& change : changes)
        if (const Surface& surface = scene_->surfaces[change.surface]; !surface.has_displacement)
            self.polygon_trees[change.surface] = build_polygon_tree(surface);
    self.trees->change_scene(changes);
    self.follow_camera(*scene_);
    self.remove_changed(changes);
    return true;
}

void Tracer::closest_hits(std::span<const TraceRay> rays, std::span<TraceHit> hits, int depth,
                          uint32_t mask) const {
    const Implementation& self = *implementation_;
    if (self.is_hidden(mask)) {
        std::fill(hits.begin(), hits.end(), TraceHit{});
        return;
    }
    Batch batch(self, 2 * size_t(depth), rays.size(), mask);
    trace_closest(batch, rays, hits);
}

bool Tracer::may_order(size_t count) const {
    const Implementation& self = *implementation_;
    return count >= kLeastOrdered && self.trees && self.view.lod == LodRule::field &&
           self.most_tree_bytes > self.cache->cap_byte_count();
}

bool Tracer::ordered_hits(std::span<const TraceRay> rays, std::span<TraceHit> hits, OrderedQuery query,
                          uint32_t mask) const {
    const Implementation& self = *implementation_;
    if (!may_order(rays.size()) || self.is_hidden(mask)) return false;
    const size_t room = self.cache->find_room();
    if (room < kLeastOrderedRoom || self.most_tree_bytes <= room) return false;
    const RunCast run = [&](size_t count, const auto& work) {
        Batch batch(self, query == OrderedQuery::any ? 1 : 0, count, mask);
        work(batch.view, batch.context);
    };
    return trace_ordered({*self.kernels, self.view, run, query, rays, room - room / kLostShare}, hits);
}

void Tracer::continued_hits(std::span<const TraceRay> rays, std::span<TraceHit> hits, int depth) const {
    Batch batch(*implementation_, 2 * size_t(depth), 0);
    trace_closest(batch, rays, hits);
}

void Tracer::trace_closest(Batch& batch, std::span<const TraceRay> rays, std::span<TraceHit> hits) const {
    const Implementation& self = *implementation_;
    if (self.trees)
        self.kernels->closest_hits(batch.view, batch.context, rays.data(), hits.data(), rays.size());
    else
        self.walk->closest_hits(batch.view, self.kernels->primitive, batch.context, rays.data(), hits.data(),
                                rays.size());
}

void Tracer::camera_hits(const scalar::CameraFrame& camera, std::span<const Vec2f> positions,
                         std::span<TraceRay> rays, std::span<TraceHit> hits) const {
    DCHECK(camera.aperture_radius == 0 && hits.size() == positions.size());
    DCHECK(rays.empty() || rays.size() == positions.size());
    const Implementation& self = *implementation_;
    if (self.trees) {
        Batch batch(self, 0, positions.size());
        self.kernels->camera_hits(batch.view, batch.context, {camera, positions.data(), positions.size()},
                                  rays.empty() ? nullptr : rays.data(), hits.data());
        return;
    }
    std::vector<TraceRay> aimed(rays.empty() ? positions.size() : 0);
    const std::span<TraceRay> all = rays.empty() ? std::span(aimed) : rays;
    self.shading->aim_rays(camera, positions.data(), positions.size(), all.data());
    closest_hits(all, hits);
}

void Tracer::any_hits(std::span<const TraceRay> rays, std::span<uint8_t> occluded, int depth,
                      uint32_t mask) const {
    const Implementation& self = *implementation_;
    if (self.is_hidden(mask)) {
        std::fill(occluded.begin(), occluded.end(), uint8_t(0));
        return;
    }
    Batch batch(self, 2 * size_t(depth) + 1, rays.size(), mask);
    if (self.trees)
        self.kernels->any_hits(batch.view, batch.context, rays.data(), occluded.data(), rays.size());
    else
        self.walk->any_hits(batch.view, self.kernels->primitive, batch.context, rays.data(), occluded.data(),
                            rays.size());
}

SurfacePoint Tracer::make_surface_point(const TraceHit& hit) const {
    const std::optional<PatchSamples> samples = unpack_patch(*scene_, hit);
    return make_shading_point(*scene_, hit, samples ? &*samples : nullptr);
}

SurfacePoint Tracer::evaluate_point(uint32_t instance, uint32_t patch, Vec2f uv, uint32_t lod_bias) const {
    const TraceHit hit = locate_hit(*scene_, instance, patch, uv, lod_bias);
    const std::optional<PatchSamples> samples = unpack_patch(*scene_, hit);
    SurfacePoint point = make_cell_point(*scene_, hit, samples ? &*samples : nullptr);
    if (scene_->textured.has_vertex_numbers)
        point.uv = find_uv(*scene_, hit); // an emitter may have a texture
    return point;
}

void Tracer::make_surface_points(std::span<const TraceHit> hits, std::span<SurfacePoint> points,
                                 PointScratch& scratch) const {
    make_points(*scene_, *implementation_->shading, hits, points, scratch);
}

const ShadingKernels& Tracer::shading_kernels() const { return *implementation_->shading; }

Vec3f Tracer::offset_origin(const SurfacePoint& point, const Vec3f& direction) const {
    return scalar::offset_origin(point.position, point.geometric_normal, point.position_error, direction);
}

void Tracer::add_statistics(Statistics& statistics) const {
    const Implementation& self = *implementation_;
    statistics.isa = self.kernels->name;
    const TraceCounters counters = self.cache->sum_counters();
    statistics.pairs_emitted += counters.pairs_emitted, statistics.pairs_with_hit += counters.pairs_with_hit;
    statistics.upper_nodes += counters.upper_nodes, statistics.patch_nodes += counters.patch_nodes;
    statistics.blocks += counters.blocks;
    statistics.bottom_built += counters.built, statistics.bottom_reused += counters.reused;
    statistics.bottom_rebuilt += counters.rebuilt;
    statistics.bottom_levels.resize(kTileLevel + 1);
    for (int level = 0; level <= kTileLevel; ++level)
        statistics.bottom_levels[size_t(level)] += counters.built_at_level[level];
    self.add_casts(statistics);
    if (self.walk) statistics.structures_bytes += self.walk->byte_count();
    if (self.trees) statistics.structures_bytes += self.trees->current()->byte_count();
    for (const PolygonTree& tree : self.polygon_trees) statistics.structures_bytes += tree.byte_count();
    statistics.bottom_cache_bytes += self.cache->peak_byte_count();
    for (const Surface& surface : scene_->surfaces) statistics.geometry_bytes += surface.geometry_bytes();
    for (const Instance& instance : scene_->instances) statistics.geometry_bytes += count_bytes(instance);
}

size_t Tracer::count_plain_bytes() const {
    size_t bytes = 0;
    for (const PolygonTree& tree : implementation_->polygon_trees) bytes += tree.byte_count();
    for (const Surface& surface : scene_->surfaces)
        if (!surface.has_displacement) bytes += surface.geometry_bytes();
    for (const Instance& instance : scene_->instances)
        if (!scene_->surfaces[instance.surface].has_displacement) bytes += count_bytes(instance);
    return bytes;
}

} // namespace relief::cpu
