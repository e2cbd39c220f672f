// The CPU engine: tiles of the picture over all threads, pass by pass; batches of rays for other programs.
#include "cpu/cpu_engine.h"
#include "cpu/ordered_hits.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "base/machine.h"
#include "base/parallel.h"
#include "base/timer.h"
#include "cpu/patch_trees/patch_tree_cache.h"
#include "cpu/path_tracer.h"
#include "cpu/picture_footprints.h"
#include "cpu/tiles.h"
#include "cpu/tracer.h"

namespace relief {

namespace cpu {

namespace {

/// Rays that one worker traces between two looks at the queue.
constexpr size_t kBatchSize = 1024;
constexpr double kReportInterval = 0.1; ///< seconds between two reports of progress
constexpr int kLongestPass = 16;        ///< samples a pixel between two passes over the picture

/// Tells the observer how far the work is: from whichever worker is free to, never from two at once.
class Reporter {
  public:
    Reporter(RenderObserver* observer, uint64_t total, int samples) : observer_(observer), total_(total) {
        progress_.samples_total = samples;
    }

    bool is_cancelled() const { return observer_ && observer_->is_cancelled(); }

    void finish_tile(uint64_t pixel_samples, uint64_t rays) {
        done_ += pixel_samples, rays_ += rays;
        const std::unique_lock lock(mutex_, std::try_to_lock);
        if (lock && timer_.seconds() - progress_.elapsed_s >= kReportInterval) report();
    }

    void finish_pass(int samples_done) {
        const std::lock_guard lock(mutex_);
        progress_.samples_done = samples_done;
        report();
    }

  private:
    void report() {
        if (!observer_) return;
        progress_.fraction = total_ > 0 ? double(done_) / double(total_) : 1;
        progress_.rays = rays_;
        progress_.elapsed_s = timer_.seconds();
        observer_->on_progress(progress_);
    }

    RenderObserver* observer_;
    uint64_t total_;
    std::atomic<uint64_t> done_{0}, rays_{0};
    std::mutex mutex_;
    Progress progress_;
    Timer timer_;
};

class CpuEngine final : public Engine {
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

    void expect_changes() override { expects_changes_ = !tracer_.displaced_bounds().is_empty(); }

    bool render(Film& film, RenderObserver* observer) override {
        // A surface that glows is drawn as a light from everywhere: nothing could be kept.
        if (!expects_changes_ || lights_.has_emitters())
            return trace_tiles(film, cut_into_windows(film.window(), kTileEdge), observer);
        footprints_.emplace(film.window(), tracer_.displaced_bounds());
        return trace_stale_tiles(film, observer);
    }

    bool refresh(Film& film, RenderObserver* observer) override {
        return footprints_ ? trace_stale_tiles(film, observer) : Engine::refresh(film, observer);
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
        parallel_for("any_hits", rays.size(), kBatchSize, [&](size_t begin, size_t end) {
            const std::vector<TraceRay> batch = make_batch(rays.subspan(begin, end - begin));
            tracer_.any_hits(batch, hits.subspan(begin, end - begin), 0, mask);
        });
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
        tracer_.add_statistics(statistics);
    }

  private:
    bool trace_stale_tiles(Film& film, RenderObserver* observer) {
        const std::vector<Window> tiles = footprints_->start_stale_windows(kTileEdge);
        for (const Window& tile : tiles) film.clear(tile);
        const bool is_complete = trace_tiles(film, tiles, observer);
        if (is_complete) footprints_->finish();
        return is_complete;
    }

    bool trace_tiles(Film& film, const std::vector<Window>& tiles, RenderObserver* observer) {
        const Timer timer;
        uint64_t pixels = 0;
        for (const Window& tile : tiles) pixels += count_pixels(tile);
        Reporter reporter(observer, pixels * uint64_t(settings_.image.spp), settings_.image.spp);
        const Tracer::StopScope scope(tracer_, [&] { return reporter.is_cancelled(); });
        first_image_s_ = 0;
        int done = 0, length = 1;
        while (done < settings_.image.spp && !reporter.is_cancelled()) {
            tracer_.rebuild_if_worthwhile();
            const SampleRange samples{settings_.image.first_sample + done,
                                      std::min(length, settings_.image.spp - done)};
            if (!render_pass(film, tiles, samples, reporter)) break;
            done += samples.count;
            if (first_image_s_ == 0) first_image_s_ = timer.seconds();
            reporter.finish_pass(done);
            length = std::min(2 * length, kLongestPass);
        }
        return done == settings_.image.spp;
    }

    /// Whether all tiles have these samples, which they may have although the render was cancelled meanwhile.
    bool render_pass(Film& film, const std::vector<Window>& tiles, SampleRange samples, Reporter& reporter) {
        std::mutex mutex;
        size_t done = 0;
        parallel_for("render_pass", tiles.size(), 1, [&](size_t begin, size_t end) {
            for (size_t k = begin; k < end && !reporter.is_cancelled(); ++k) {
                const Window& tile = tiles[k];
                TileReport report;
                if (footprints_) report.footprints = &*footprints_;
                try {
                    trace_tile({tracer_, lights_, settings_}, film, tile, samples, report);
                } catch (const StopRequest&) {
                    return; // the film has the whole samples before it
                }
                const TileCounters& counters = report.counters;
                reporter.finish_tile(count_pixels(tile) * uint64_t(samples.count),
                                     counters.camera_rays + counters.shadow_rays + counters.bounce_rays);
                const std::lock_guard lock(mutex);
                ++done;
                counters_.camera_rays += counters.camera_rays;
                counters_.shadow_rays += counters.shadow_rays;
                counters_.bounce_rays += counters.bounce_rays;
                counters_.shade_s += counters.shade_s;
                counters_.film_s += counters.film_s;
            }
        });
        return done == tiles.size();
    }

    bool find_ordered_hits(std::span<const Ray> rays, std::span<RayHit> hits, uint32_t mask) const {
        if (!tracer_.may_order(rays.size())) return false;
        const std::vector<TraceRay> batch = make_batch(rays);
        std::vector<TraceHit> found(batch.size());
        if (!tracer_.ordered_hits(batch, found, mask)) return false;
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
