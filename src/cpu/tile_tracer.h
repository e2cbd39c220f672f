// The wavefront of one tile: path_tracer.cpp traces its rays, tile_shading.cpp shades what they hit.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "cpu/bounce_rays.h"
#include "cpu/cut_outs.h"
#include "cpu/path_lights.h"
#include "cpu/path_tracer.h"
#include "cpu/shading/point_material.h"
#include "cpu/shading/shading_kernels.h"
#include "cpu/shading/vertex_inputs.h"
#include "formulas/camera.h"
#include "formulas/glass_parameters.h"
#include "formulas/light_tree.h"
#include "formulas/path.h"

namespace relief::cpu {

/// What a path brings from vertex to vertex, a line of the cache; its ray and hit are in the wave.
struct alignas(64) Path {
    Vec3f throughput{1, 1, 1};
    scalar::LitPoint previous{}; ///< the vertex that the ray left
    float bsdf_pdf = 0;          ///< with which the ray was drawn there
    uint32_t body = kNoIndex;    ///< of solid glass that the ray is in: record of PreparedScene::glass
    Vec3f radiance{};            ///< as in FilmSample, where finish_paths() puts it; likewise cost
    float cost = 1;
};
static_assert(sizeof(Path) == 64);

struct ShadowRay {
    uint32_t path;
    Vec3f contribution;
};

/// All paths of some samples advance together, so that rays and hits reach the SIMD kernels in packets. Entry
/// k of the wave's arrays belongs to the path active_[k].
class TileTracer {
  public:
    TileTracer(const PathTracerScene& scene, Film& film, const Window& tile, TileReport& report);
    /// At most kMostSamples.
    void trace_samples(SampleRange samples);

    static constexpr int kMostSamples = 16;

  private:
    bool is_pinhole() const { return camera_.aperture_radius == 0; }
    int last_depth() const { return int(scalar::find_last_depth(uint32_t(settings_.image.bounces))); }
    void start_paths(SampleRange samples);
    void finish_paths();
    void trace_paths();
    float draw_cut_out(uint32_t path, bool is_shadow, uint32_t round) const {
        return scalar::draw_cut_out(seeds_[path], samples_[path], uint32_t(depth_), is_shadow ? 1 : 0, round);
    }
    void pass_shadow_rays();
    void note_ray(uint32_t path, const TraceRay& ray, float t_end);
    void shade_paths();
    void shade_vertices();
    void add_last_emission();
    void add_backgrounds();
    void add_background(uint32_t path, const Vec3f& light);
    void gather_lights();
    void note_sky();
    void add_lights_before(size_t k, const Vec3f& share, const EnvironmentLookup& behind);
    bool is_catcher(size_t k) const;
    void cover_catchers();
    void drop_misses();
    void draw_random();
    void sample_2d(uint32_t pair, std::vector<Vec2f>& drawn) const;
    void list_wave_samples();
    size_t shade_block(size_t first, size_t count, size_t next);
    void draw_lights(size_t first, size_t count);
    void meet_materials(size_t first, size_t count, BaseColor base_color);
    void meet_material(size_t k, size_t n);
    void reflect(size_t first, size_t count);
    float find_lift(size_t k, size_t n);
    bool is_covered(size_t k, float lift);
    const scalar::GlassParameters* find_body(uint32_t body) const {
        return body == kNoIndex ? nullptr : &tracer_.scene().glass.records[body];
    }
    void pass_wall(size_t k, const Vec3f& left);
    uint32_t choose_body(size_t k, const VertexLanes& lanes, size_t lane, const Vec3f& direction) const;
    void record_first_hit(size_t k, const VertexLanes& lanes, size_t lane);
    void note_guides(size_t k, const VertexLanes& lanes, size_t lane, const Vec3f& emission);
    Vec3f add_found_light(uint32_t path, const Vec3f& light);
    void add_emission(size_t k, const Vec3f& emission);
    void add_shadow_ray(size_t k, const VertexLanes& lanes, size_t lane, const LightSample& light);
    bool continue_path(size_t k, const VertexLanes& lanes, size_t lane, size_t next);
    void add_shadow_light(size_t k);
    void trace_shadow_rays();

    static constexpr size_t kBlock = 64; ///< vertices that are at work at once: as many as a cache holds

    const Tracer& tracer_;
    const LightSet& lights_;
    const RenderSettings& settings_;
    Film& film_;
    TileCounters& counters_;
    PictureFootprints* footprints_;
    const bool has_glass_, has_catchers_;
    scalar::CameraFrame camera_;
    scalar::BounceLod bounce_lod_;
    struct Pixel {
        int x, y;
        uint32_t seed;
    };
    const Pixel& find_pixel(size_t path) const { return pixels_[path / sample_count_]; }
    std::vector<Pixel> pixels_;             ///< in packets of kPacketEdge squared
    uint32_t sample_count_ = 0;             ///< of each
    int depth_ = 0;                         ///< vertices behind the wave: 0 for camera rays
    std::vector<Path> paths_;               ///< all samples of a pixel after those of the one before
    std::vector<FilmSample> first_hits_;    ///< of paths_; radiance and cost only from finish_paths() on
    std::vector<uint32_t> seeds_, samples_; ///< of paths_: of the pixel, and the number of the sample

    std::vector<uint32_t> active_; ///< paths still on their way, in order
    std::vector<TraceRay> rays_;
    std::vector<float> coarse_from_; ///< see closest_bounce_hits; of bounce rays
    std::vector<TraceHit> hits_;
    std::vector<Vec2f> places_; ///< of camera rays in the picture, in pixels
    std::vector<uint32_t> missed_;
    std::vector<Vec3f> directions_; ///< of rays that missed
    std::vector<EnvironmentLookup> backgrounds_;
    std::vector<SurfacePoint> points_;
    std::vector<Vec3f> tangents_;                                    ///< of points on anisotropic materials
    std::vector<uint32_t> wave_seeds_, wave_samples_;                ///< of active_
    std::array<std::vector<Vec2f>, scalar::kPairsPerBounce> random_; ///< by kind of pair

    std::array<VertexLanes, kBlock / 16> lanes_{};
    VertexInputs vertex_inputs_;
    std::array<PointMaterial, kBlock> materials_;
    std::array<LightSet::Receiver, kBlock> receivers_;
    std::array<LightSet::RandomNumbers, kBlock> light_random_;
    std::array<LightSample, kBlock> lights_drawn_;

    std::vector<TraceRay> shadow_rays_;
    std::vector<ShadowRay> shadows_; ///< what each shadow ray brings if nothing is in its way
    std::vector<uint8_t> occluded_;
    PathLights path_lights_;
    PointScratch scratch_;
    BounceScratch bounce_scratch_;
    CutOutScratch cut_out_scratch_;
    std::vector<uint32_t> stopped_; ///< shadow rays that meet something
    std::vector<TraceRay> stopped_rays_;
    std::vector<TraceHit> stoppers_;
};

} // namespace relief::cpu
