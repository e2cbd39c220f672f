// The Vulkan engine: passes over the picture, batch by batch, and ray queries.
#include "vulkan/vulkan_engine.h"

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/stop_request.h"
#include "base/timer.h"
#include "engine/picture_windows.h"
#include "engine/render_passes.h"
#include "relief/error.h"
#include "vulkan/layout/device_rays.h"
#include "vulkan/path_tracer.h"
#include "vulkan/ray_batch.h"
#include "vulkan/sized_tracer.h"

namespace relief {

namespace vulkan {

namespace {

constexpr uint32_t kMostPaths = 1u << 20;
constexpr uint32_t kMostPathsOfLargeDevice = 1u << 21;
constexpr uint64_t kLargeDeviceBytes = uint64_t(12) << 30; ///< free
constexpr uint32_t kLeastPaths = 1u << 12; ///< with less, the device has too little memory to render
constexpr uint32_t kRaysOfABatch = 1u << 17;
constexpr uint32_t kSlots = 4;
/// Pixels a side of a task: the least number of paths holds one. Of one that is drawn: kMostPaths hold one.
constexpr int kTaskEdge = 64, kDrawnEdge = 1024;
static_assert(kTaskEdge * kTaskEdge == kLeastPaths && kDrawnEdge * kDrawnEdge == kMostPaths);

class VulkanEngine final : public Engine, private PassTracer {
  public:
    VulkanEngine(std::unique_ptr<Device> device, std::shared_ptr<const PreparedScene> scene,
                 const RenderSettings& settings, const std::optional<SceneWalk>& walk)
        : scene_(std::move(scene)),
          settings_(settings),
          device_(std::move(device)),
          has_walk_(walk.has_value()),
          device_scene_(*device_, *scene_, walk ? &*walk : nullptr) {}

    /// Unsupported: texels and trees on the device are immutable.
    bool apply_changes(std::span<const SurfaceChange>) override { return false; }
    bool render(Film& film, const RenderControl& control) override;
    void closest_hits(std::span<const Ray> rays, std::span<RayHit> hits, uint32_t mask) const override;
    void any_hits(std::span<const Ray> rays, std::span<uint8_t> hits, uint32_t mask) const override;
    void add_statistics(Statistics& statistics) const override;

  private:
    std::unique_ptr<Tracer> make_tracer(uint32_t rays, uint32_t share) const;
    void make_paths(const Window& window);
    SizedTracer<RayBatch>& batches() const;
    uint64_t count_rays() const;
    void require_drawable(const Window& window) const;
    /// A device sums up the samples of a step, in single precision.
    bool keeps_bits() const override { return false; }
    void trace(Film& film, std::span<const SampleTask> tasks, PassMonitor& monitor) override;
    void trace_tasks(Film& film, std::span<const SampleTask> tasks, PassMonitor& monitor);

    std::shared_ptr<const PreparedScene> scene_;
    RenderSettings settings_;
    std::unique_ptr<Device> device_;
    bool has_walk_; ///< of the lab
    DeviceScene device_scene_;
    SizedTracer<PathTracer> paths_;
    mutable std::mutex mutex_;
    mutable SizedTracer<RayBatch> batches_;
    uint64_t rays_reported_ = 0;
    double set_up_s_ = 0, first_image_s_ = 0;
};

/// Casts 1 / `share` of the `rays` capacity at a time.
std::unique_ptr<Tracer> VulkanEngine::make_tracer(uint32_t rays, uint32_t share) const {
    TracerConfig config;
    config.ray_capacity = rays;
    config.slots = kSlots;
    // A launch costs a GPU more than what a few candidates too many cost it.
    config.collected = device_->is_cpu() || has_walk_ ? 0 : scalar::kMostCollected;
    config.pair_capacity = rays / share * kSlots;
    return std::make_unique<Tracer>(*device_, *scene_, device_scene_, settings_, config);
}

/// Checks the limits of the hybrid method for a window.
void VulkanEngine::require_drawable(const Window& window) const {
    const uint32_t most = device_->max_draw_size();
    if (settings_.experiment.method != RenderMethod::hybrid ||
        (uint32_t(window.x1 - window.x0) <= most && uint32_t(window.y1 - window.y0) <= most))
        return;
    throw Error(ErrorKind::usage,
                {fmt::format("the hybrid method draws at most {} pixels a side on this device", most),
                 device_->description().name, "image.crop, or experiment.method = compute or fragment"});
}

/// Compiles the kernels.
void VulkanEngine::make_paths(const Window& window) {
    const uint64_t pixels = count_pixels(window);
    const Timer set_up;
    // Every path has a ray and a shadow ray.
    paths_ = {}; // frees its memory
    const bool is_large = !device_->is_cpu() && settings_.experiment.method != RenderMethod::hybrid &&
                          device_->available_bytes() >= kLargeDeviceBytes;
    const uint32_t most = is_large ? kMostPathsOfLargeDevice : kMostPaths;
    paths_ = {{2 * uint32_t(std::clamp<uint64_t>(pixels, 1, most)),
               2 * uint32_t(std::clamp<uint64_t>(pixels, 1, kLeastPaths))},
              [this](uint32_t rays) { return make_tracer(rays, 2); },
              [this](Tracer& tracer) { return std::make_unique<PathTracer>(tracer, settings_); }};
    set_up_s_ += set_up.seconds();
}

bool VulkanEngine::render(Film& film, const RenderControl& control) {
    require_drawable(film.window());
    try {
        std::optional<Device::StopScope> scope;
        if (control.observer) scope.emplace(*device_, [&] { return control.observer->is_cancelled(); });
        make_paths(film.window());
    } catch (const StopRequest&) {
        return false;
    }
    rays_reported_ = 0;
    const bool draws = settings_.experiment.method == RenderMethod::hybrid;
    const PassReport report =
        render_passes(film, settings_.image, control, draws ? kDrawnEdge : kTaskEdge, *this);
    first_image_s_ = report.first_image_s;
    return report.is_complete;
}

void VulkanEngine::trace(Film& film, std::span<const SampleTask> tasks, PassMonitor& monitor) {
    const Device::StopScope scope(*device_,
                                  [&] { return monitor.is_cancelled() || monitor.is_out_of_time(); });
    try {
        trace_tasks(film, tasks, monitor);
    } catch (const StopRequest&) {
        return; // the film has the whole samples before it
    }
}

/// Tasks of the same samples together, as many as the device has room for.
void VulkanEngine::trace_tasks(Film& film, std::span<const SampleTask> tasks, PassMonitor& monitor) {
    const bool draws = settings_.experiment.method == RenderMethod::hybrid;
    const auto report = [&](uint64_t pixel_samples) {
        const uint64_t rays = count_rays();
        monitor.finish_task(pixel_samples, rays - rays_reported_);
        rays_reported_ = rays;
    };
    for (size_t next = 0; next < tasks.size() && !monitor.must_stop();) {
        const SampleTask& first = tasks[next];
        const SampleRange samples{settings_.image.first_sample + first.first, first.count};
        uint64_t done = 0;
        size_t end = next;
        paths_.run([&](PathTracer& worker) {
            std::vector<PixelRange> ranges;
            uint64_t count = 0;
            for (end = next; end < tasks.size() && tasks[end].first == first.first && (!draws || end == next);
                 ++end) {
                const uint64_t pixels = count_pixels(tasks[end].window);
                if (end > next && count + pixels > worker.capacity()) break;
                ranges.push_back({tasks[end].window, 0, pixels}), count += pixels;
            }
            // One task may be more than a device has room for; what a failed attempt has traced of it stays.
            if (ranges.size() > 1 || count <= worker.capacity()) {
                worker.trace_samples(film, ranges, samples, report);
                done = count;
            }
            for (; done < count; done += ranges[0].count) {
                ranges[0].first = done, ranges[0].count = std::min<uint64_t>(worker.capacity(), count - done);
                worker.trace_samples(film, ranges, samples, report);
            }
        });
        next = end;
    }
}

uint64_t VulkanEngine::count_rays() const {
    Statistics work;
    paths_.add_statistics(work);
    return work.camera_rays + work.shadow_rays + work.bounce_rays;
}

SizedTracer<RayBatch>& VulkanEngine::batches() const {
    if (!batches_)
        batches_ = {{kRaysOfABatch, kLeastPaths},
                    [this](uint32_t rays) { return make_tracer(rays, 1); },
                    [](Tracer& tracer) { return std::make_unique<RayBatch>(tracer); }};
    return batches_;
}

void VulkanEngine::closest_hits(std::span<const Ray> rays, std::span<RayHit> hits, uint32_t mask) const {
    const std::lock_guard lock(mutex_);
    batches().run([&](RayBatch& worker) { worker.closest_hits(rays, hits, mask); });
}

void VulkanEngine::any_hits(std::span<const Ray> rays, std::span<uint8_t> hits, uint32_t mask) const {
    const std::lock_guard lock(mutex_);
    batches().run([&](RayBatch& worker) { worker.any_hits(rays, hits, mask); });
}

void VulkanEngine::add_statistics(Statistics& statistics) const {
    statistics.engine = "vulkan";
    statistics.device = device_->description().name;
    statistics.isa = device_->description().driver;
    // Creating kernels and buffers does not count as frame time.
    statistics.prepare_s += set_up_s_;
    statistics.render_s -= set_up_s_;
    statistics.first_image_s += first_image_s_;
    paths_.add_statistics(statistics);
    statistics.geometry_bytes += device_->peak_bytes(Purpose::geometry);
    statistics.structures_bytes += device_->peak_bytes(Purpose::structures);
    statistics.displacement_bytes += device_->peak_bytes(Purpose::displacement);
    statistics.bottom_cache_bytes += device_->peak_bytes(Purpose::bottom_cache);
    statistics.ray_buffers_bytes +=
        device_->peak_bytes(Purpose::ray_buffers) + device_->peak_bytes(Purpose::staging);
}

} // namespace

std::unique_ptr<Engine> make_engine_on(std::unique_ptr<Device> device,
                                       std::shared_ptr<const PreparedScene> scene,
                                       const RenderSettings& settings, const std::optional<SceneWalk>& walk) {
    return std::make_unique<VulkanEngine>(std::move(device), std::move(scene), settings, walk);
}

} // namespace vulkan

std::unique_ptr<Engine> make_vulkan_engine(std::shared_ptr<const PreparedScene> scene,
                                           const RenderSettings& settings,
                                           const std::optional<vulkan::SceneWalk>& walk) {
    const vulkan::Device::Config config{.index = settings.device.index,
                                        .method = settings.experiment.method,
                                        .pipeline_cache = settings.device.pipeline_cache};
    return vulkan::make_engine_on(std::make_unique<vulkan::Device>(config), std::move(scene), settings, walk);
}

} // namespace relief
