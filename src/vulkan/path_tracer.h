// Path tracing of a batch of pixels on the device: all paths of one sample advance together, kernel by
// kernel. The counterpart of cpu/path_tracer.h, with the same random numbers and formulas.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "film/film.h"
#include "formulas/camera.h"
#include "relief/render.h"
#include "vulkan/device_lights.h"
#include "vulkan/layout/device_paths.h"
#include "vulkan/rasteriser.h"
#include "vulkan/tracer.h"

namespace relief::vulkan {

/// Pixels [first, first + count) of the film's window, in the order of scalar::place_pixel.
struct PixelRange {
    uint64_t first = 0, count = 0;
};

/// Samples [first, first + count) of each pixel.
struct SampleRange {
    int first = 0, count = 1;
};

/// One thread at a time. All of it is synchronous.
class PathTracer {
  public:
    /// Binds its tables to the tracer's bindings. A pass holds half as many paths as the tracer has places
    /// for rays. The tracer must outlive it. Throws Error{out_of_memory}.
    PathTracer(Tracer& tracer, const RenderSettings& settings);

    /// Paths that are traced at once.
    uint32_t capacity() const { return capacity_; }

    /// Adds samples to the film. Sample k of a pixel depends on (seed, pixel, k) only. Any number of pixels
    /// and samples; multiples of capacity() and kSamplesPerLaunch are best.
    void trace_samples(Film& film, PixelRange pixels, SampleRange samples);

    /// Rays by kind and casts by depth, of whole batches.
    void add_statistics(Statistics& statistics) const;

    /// Samples of a pixel that are summed up on the device, in single precision.
    static constexpr int kSamplesPerLaunch = 16;

  private:
    struct NextRays {
        uint32_t path_count, shadow_count;
    };
    void trace_batch(Film& film, PixelRange pixels, SampleRange samples);
    void make_buffers();
    void trace_sample(const Film& film, PixelRange pixels, uint32_t sample_index);
    NextRays shade_depth(const scalar::PathPush& push);
    void trace_shadow_rays(scalar::PathPush push, uint32_t shadow_count);
    void add_to_film(Film& film, PixelRange pixels, int sample_count) const;
    scalar::PathPush make_push(uint32_t sample_index) const;

    Tracer& tracer_;
    RenderSettings settings_;
    scalar::CameraFrame camera_;
    uint32_t capacity_;
    DeviceLights lights_;
    Kernel camera_kernel_, background_, surface_point_, shading_normal_, light_sample_, bounce_,
        shadow_light_, film_;
    Buffer paths_, points_, film_sums_, path_list_, next_path_list_, shadow_list_;
    std::unique_ptr<Rasteriser> rasteriser_;          ///< of the hybrid method
    std::vector<CastStatistics> casts_, batch_casts_; ///< of whole batches; of the one under way
    double film_s_ = 0;                               ///< of the host, for sums that come back
};

} // namespace relief::vulkan
