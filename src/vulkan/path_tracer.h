// Wavefront path tracing of a batch of pixels on the device: all paths of one sample advance together, kernel
// by kernel. Counterpart of cpu/path_tracer.h, with the same random numbers and formulas.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "film/film.h"
#include "formulas/camera.h"
#include "relief/render.h"
#include "vulkan/device_lights.h"
#include "vulkan/film_reader.h"
#include "vulkan/layout/device_paths.h"
#include "vulkan/rasteriser.h"
#include "vulkan/tracer.h"

namespace relief::vulkan {

/// Pixels [first, first + count) of a window of the picture, in the order of scalar::place_pixel.
struct PixelRange {
    Window window;
    uint64_t first = 0, count = 0;
};

/// Samples [first, first + count) of each pixel.
struct SampleRange {
    int first = 0, count = 1;
};

/// Not thread safe; all calls are synchronous.
class PathTracer {
  public:
    /// Binds its buffers to the tracer, which must outlive it, at half its capacity. Error{out_of_memory}.
    PathTracer(Tracer& tracer, const RenderSettings& settings);

    /// Paths traced at a time.
    uint32_t capacity() const { return capacity_; }

    /// Adds samples to the film. Sample k of a pixel depends on (seed, pixel, k) only. Any number of samples,
    /// and of pixels (not of ranges that are drawn) up to capacity(), which is most efficient. `on_samples`
    /// is told how many samples of pixels are new. After StopRequest the film has the whole samples before
    /// it; only those of the last launch on a device that is no CPU are lost.
    void trace_samples(
        Film& film, std::span<const PixelRange> pixels, SampleRange samples,
        const std::function<void(uint64_t)>& on_samples = [](uint64_t) {});

    /// Adds rays by kind and casts by depth.
    void add_statistics(Statistics& statistics) const;

    /// Samples per pixel summed on the device, in single precision.
    static constexpr int kSamplesPerLaunch = 16;

  private:
    struct NextRays {
        uint32_t path_count, shadow_count;
    };
    void trace_batch(Film& film, SampleRange samples, const std::function<void(uint64_t)>& on_samples);
    Kernel make_lighting_kernel(const char* shader) const;
    Kernel make_scattering_kernel(const char* shader) const;
    void make_buffers();
    /// `place`: of the sample in its launch.
    void trace_sample(uint32_t sample_index, int place);
    uint64_t find_light_sums() const;
    uint64_t find_first_hits(int place) const;
    void clear_sums(int sample_count);
    CastStatistics trace_bounces(scalar::PathPush push);
    void pass_cut_outs(scalar::PathPush push, bool is_shadow, CastStatistics& cast);
    NextRays shade_depth(const scalar::PathPush& push);
    NextRays list_rays(const Kernel& kernel, const scalar::PathPush& push);
    void clear_lists();
    NextRays read_lists();
    CastStatistics lift_shadow_rays(scalar::PathPush push, uint32_t shadow_count);
    void trace_shadow_rays(scalar::PathPush push, uint32_t shadow_count);
    void add_to_film(Film& film, const Buffer& light_sums, const BatchSums& sums, int sample_count);
    std::vector<uint32_t> download_first_hits(int sample_count) const;
    scalar::PathPush make_push(uint32_t sample_index) const;

    Tracer& tracer_;
    RenderSettings settings_;
    scalar::CameraFrame camera_;
    uint32_t capacity_;
    LightLayers light_layers_;
    bool notes_first_hits_; ///< of every sample, behind the film's other sums
    DeviceLights lights_;
    FilmReader film_reader_;
    Kernel camera_kernel_, background_, surface_point_, shading_normal_, meet_surface_, light_sample_,
        bounce_, far_rays_, inner_hits_, shadow_light_, film_;
    std::optional<Kernel> cut_outs_;                ///< where the scene has some
    std::optional<Kernel> lifted_rays_, lift_rays_; ///< where shadow rays may start above their triangles
    Buffer saved_list_;                             ///< where rays come from that pass them
    Buffer paths_, points_, film_sums_, path_list_, next_path_list_, shadow_list_, pixel_list_;
    Buffer whole_sums_;                               ///< CPU devices only: the film sums of whole samples
    std::vector<uint32_t> pixels_;                    ///< of the current batch, pack_pixel()
    PixelRange drawn_;                                ///< what the rasteriser draws of them: all
    std::unique_ptr<Rasteriser> rasteriser_;          ///< hybrid method only
    std::vector<CastStatistics> casts_, batch_casts_; ///< of completed batches; of the current one
    double film_s_ = 0;                               ///< on the host, adding sums to the film
};

} // namespace relief::vulkan
