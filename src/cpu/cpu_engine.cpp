// The CPU engine: tiles of the picture over all threads, pass by pass; batches of rays for other programs.
#include "cpu/cpu_engine.h"
#include "cpu/ordered_hits.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "base/machine.h"
#include "base/parallel.h"
#include "base/stop_request.h"
#include "cpu/patch_trees/patch_tree_cache.h"
#include "cpu/path_tracer.h"
#include "cpu/picture_footprints.h"
#include "cpu/tracer.h"
#include "engine/picture_windows.h"
#include "engine/render_passes.h"

namespace relief {

namespace cpu {

namespace {

/// Rays that one worker traces between two looks at the queue.
constexpr size_t kBatchSize = 1024;

class CpuEngine final : public Engine, private PassTracer {
  public:
    CpuEngine(std::shared_ptr<const PreparedScene> scene, const RenderSettings& settings,
              std::unique_ptr<const SceneWalk> walk)
        : settings_(settings), tracer_(std::move(scene), settings, std::move(walk)), lights_(tracer_) {}

    bool apply_changes(std::span<const SurfaceChange> changes) override {
        std::optional<PictureFootprints> kept = std::move(footprints_);
        footprints_.reset();
        std::vector<Box> places;
        if (!tracer_.apply_changes(changes, places)) return false;
        lights_.follow_surfaces();
        if (kept && kept->mark_stale(places)) footprints_ = std::move(kept);
        return true;
    }

    bool change_view(std::span<const SurfaceChange> changes, const ImageSettings& image) override {
        std::vector<Box> places;
        if (!tracer_.change_view(changes, places)) return false;
        lights_.follow_surfaces();
        footprints_.reset();
        settings_.image = image;
        return true;
    }

    bool change_scene(std::span<const SurfaceChange> changes, const ImageSettings& image) override {
        if (!tracer_.change_scene(changes)) return false;
        lights_.follow_scene();
        footprints_.reset();
        settings_.image = image;
        return true;
    }

    void expect_changes() override { expects_changes_ = !tracer_.displaced_bounds().is_empty(); }

    bool render(Film& film, const RenderControl& control) override {
        // A surface that glows is drawn as a light from everywhere: nothing could be kept. Nor could blocks
        // whose number of samples depends on others.
        if (!footprints_ && expects_changes_ && !lights_.has_emitters() && settings_.image.noise == 0)
            footprints_.emplace(film.window(), tracer_.displaced_bounds());
        if (footprints_)
            for (const Window& window : footprints_->start_stale_windows()) film.clear(window);
        const PassReport report = render_passes(film, settings_.image, control, kTileEdge, *this);
        first_image_s_ = report.first_image_s;
        if (footprints_ && report.is_complete) footprints_->finish();
        return report.is_complete;
    }

    bool refresh(Film& film, const RenderControl& control) override {
        return footprints_ ? render(film, control) : Engine::refresh(film, control);
    }

    void closest_hits(std::span<const Ray> rays, std::span<RayHit> hits, uint32_t mask) const override {
        tracer_.rebuild_if_worthwhile();
        for (size_t first = 0; first < rays.size(); first += kOrderedRays) {
            const size_t count = std::min(kOrderedRays, rays.size() - first);
            if (find_ordered_hits(rays.subspan(first, count), hits.subspan(first, count), mask)) continue;
            find_hits(rays.subspan(first, count), hits.subspan(first, count), mask);
        }
    }

    void any_hits(std::span<const Ray> rays, std::span<uint8_t> hits, uint32_t mask) const override {
        tracer_.rebuild_if_worthwhile();
        for (size_t first = 0; first < rays.size(); first += kOrderedRays) {
            const size_t count = std::min(kOrderedRays, rays.size() - first);
            find_occlusion(rays.subspan(first, count), hits.subspan(first, count), mask);
        }
    }

    void add_statistics(Statistics& statistics) const override {
        statistics.engine = "cpu";
        statistics.device = processor_name();
        statistics.first_image_s += first_image_s_;
        statistics.camera_rays += counters_.camera_rays;
        statistics.shadow_rays += counters_.shadow_rays;
        statistics.bounce_rays += counters_.bounce_rays;
        statistics.shade_s += counters_.shade_s;
        statistics.film_s += counters_.film_s;
        if (footprints_) statistics.ray_buffers_bytes += footprints_->byte_count();
        lights_.add_statistics(statistics);
        tracer_.add_statistics(statistics);
    }

  private:
    void start_step() override { tracer_.rebuild_if_worthwhile(); }
    /// Samples are added one by one.
    bool keeps_bits() const override { return true; }

    void trace(Film& film, std::span<const SampleTask> tasks, PassMonitor& monitor) override {
        const Tracer::StopScope scope(tracer_, [&] { return monitor.is_cancelled(); });
        std::mutex mutex;
        parallel_for("trace_tasks", tasks.size(), 1, [&](size_t begin, size_t end) {
            for (size_t k = begin; k < end && !monitor.must_stop(); ++k) {
                const SampleTask& task = tasks[k];
                TileReport report;
                if (footprints_) report.footprints = &*footprints_;
                try {
                    trace_tile({tracer_, lights_, settings_}, film, task.window,
                               {settings_.image.first_sample + task.first, task.count}, report);
                } catch (const StopRequest&) {
                    return; // the film has the whole samples before it
                }
                const TileCounters& counters = report.counters;
                monitor.finish_task(count_pixels(task.window) * uint64_t(task.count),
                                    counters.camera_rays + counters.shadow_rays + counters.bounce_rays);
                const std::lock_guard lock(mutex);
                counters_.camera_rays += counters.camera_rays;
                counters_.shadow_rays += counters.shadow_rays;
                counters_.bounce_rays += counters.bounce_rays;
                counters_.shade_s += counters.shade_s;
                counters_.film_s += counters.film_s;
            }
        });
    }

    /// Empty where rays are not to be ordered.
    std::vector<TraceHit> find_ordered(std::span<const Ray> rays, OrderedQuery query, uint32_t mask) const {
        if (!tracer_.may_order(rays.size())) return {};
        std::vector<TraceHit> found(rays.size());
        if (!tracer_.ordered_hits(make_batch(rays), found, query, mask)) return {};
        return found;
    }

    void find_occlusion(std::span<const Ray> rays, std::span<uint8_t> hits, uint32_t mask) const {
        const std::vector<TraceHit> found = find_ordered(rays, OrderedQuery::any, mask);
        for (size_t k = 0; k < found.size(); ++k) hits[k] = found[k].is_hit();
        if (!found.empty()) return;
        parallel_for("any_hits", rays.size(), kBatchSize, [&](size_t begin, size_t end) {
            const std::vector<TraceRay> batch = make_batch(rays.subspan(begin, end - begin));
            tracer_.any_hits(batch, hits.subspan(begin, end - begin), 0, mask);
        });
    }

    bool find_ordered_hits(std::span<const Ray> rays, std::span<RayHit> hits, uint32_t mask) const {
        const std::vector<TraceHit> found = find_ordered(rays, OrderedQuery::closest, mask);
        if (found.empty()) return false;
        parallel_for("closest_hits", rays.size(), kBatchSize, [&](size_t begin, size_t end) {
            make_ray_hits(std::span(found).subspan(begin, end - begin), hits.subspan(begin, end - begin));
        });
        return true;
    }

    void find_hits(std::span<const Ray> rays, std::span<RayHit> hits, uint32_t mask) const {
        parallel_for("closest_hits", rays.size(), kBatchSize, [&](size_t begin, size_t end) {
            std::vector<TraceRay> batch = make_batch(rays.subspan(begin, end - begin));
            std::vector<TraceHit> found(batch.size());
            tracer_.closest_hits(batch, found, 0, mask);
            make_ray_hits(found, hits.subspan(begin, end - begin));
        });
    }

    static std::vector<TraceRay> make_batch(std::span<const Ray> rays) {
        std::vector<TraceRay> batch(rays.size());
        // Field by field into place: a ray that is put together elsewhere first waits for its own stores.
        for (size_t k = 0; k < rays.size(); ++k) {
            batch[k].origin = rays[k].origin, batch[k].t_min = rays[k].t_min;
            batch[k].direction = rays[k].direction, batch[k].t_max = rays[k].t_max;
        }
        return batch;
    }

    /// Normals come from the SIMD kernels, many at once.
    void make_ray_hits(std::span<const TraceHit> found, std::span<RayHit> hits) const {
        std::vector<TraceHit> there;
        for (const TraceHit& hit : found)
            if (hit.is_hit()) there.push_back(hit);
        std::vector<SurfacePoint> points(there.size());
        PointScratch scratch;
        tracer_.make_surface_points(there, points, scratch);
        size_t next = 0;
        for (size_t k = 0; k < found.size(); ++k) {
            hits[k] = {};
            if (!found[k].is_hit()) continue;
            const TraceHit& hit = found[k];
            // Sums of barycentric weights may round to more than 1.
            hits[k] = {hit.t,
                       hit.instance,
                       hit.patch,
                       {std::min(hit.u, 1.0f), std::min(hit.v, 1.0f)},
                       points[next++].geometric_normal};
        }
    }

    RenderSettings settings_;
    Tracer tracer_;
    LightSet lights_;
    TileCounters counters_;
    bool expects_changes_ = false;
    std::optional<PictureFootprints> footprints_; ///< of the last picture; empty: all of it is stale
    double first_image_s_ = 0;
};

} // namespace

} // namespace cpu

std::unique_ptr<Engine> make_cpu_engine(std::shared_ptr<const PreparedScene> scene,
                                        const RenderSettings& settings,
                                        std::unique_ptr<const cpu::SceneWalk> walk) {
    return std::make_unique<cpu::CpuEngine>(std::move(scene), settings, std::move(walk));
}

} // namespace relief
