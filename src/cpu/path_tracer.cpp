#include "cpu/path_tracer.h"

#include <algorithm>

#include "base/check.h"
#include "base/timer.h"
#include "cpu/tile_tracer.h"
#include "formulas/bsdf.h"
#include "formulas/sobol.h"
#include "prepare/bounce_lod.h"
#include "prepare/camera_frame.h"

namespace relief::cpu {

namespace {

constexpr int kPacketEdge = 4;

} // namespace

TileTracer::TileTracer(const PathTracerScene& scene, Film& film, const Window& tile, TileReport& report)
    : tracer_(scene.tracer),
      lights_(scene.lights),
      settings_(scene.settings),
      film_(film),
      counters_(report.counters),
      footprints_(report.footprints),
      has_glass_(!scene.tracer.scene().glass.empty()),
      has_catchers_(scene.tracer.scene().has_shadow_catchers),
      camera_(make_camera_frame(scene.tracer.scene())),
      bounce_lod_(make_bounce_lod(scene.tracer.scene(), scene.settings)),
      vertex_inputs_(scene.tracer.scene(), kBlock),
      path_lights_(film.light_layers(), scene.tracer.scene().light_groups, scene.settings.image) {
    for (int y0 = tile.y0; y0 < tile.y1; y0 += kPacketEdge)
        for (int x0 = tile.x0; x0 < tile.x1; x0 += kPacketEdge)
            for (int y = y0; y < std::min(y0 + kPacketEdge, tile.y1); ++y)
                for (int x = x0; x < std::min(x0 + kPacketEdge, tile.x1); ++x) {
                    pixels_.push_back(
                        {x, y, scalar::make_pixel_seed(settings_.image.seed, uint32_t(x), uint32_t(y))});
                }
}

void TileTracer::trace_samples(SampleRange samples) {
    DCHECK(samples.count <= kMostSamples);
    start_paths(samples);
    for (depth_ = 0; !active_.empty(); ++depth_) {
        trace_paths();
        shade_paths();
        trace_shadow_rays();
    }
    finish_paths();
}

void TileTracer::finish_paths() {
    const Timer timer;
    for (uint32_t i = 0; i < paths_.size(); ++i) {
        const Pixel& pixel = find_pixel(i);
        FilmSample& sample = first_hits_[i];
        sample.radiance = paths_[i].radiance, sample.cost = paths_[i].cost;
        film_.add_sample(pixel.x, pixel.y, sample);
        if (path_lights_.is_on()) film_.add_lights(pixel.x, pixel.y, path_lights_.at(i));
    }
    counters_.film_s += timer.seconds();
}

void TileTracer::start_paths(SampleRange samples) {
    sample_count_ = uint32_t(samples.count);
    const size_t count = pixels_.size() * sample_count_;
    paths_.assign(count, {}), first_hits_.assign(count, {});
    seeds_.resize(count), samples_.resize(count), active_.resize(count);
    for (uint32_t i = 0; i < count; ++i) {
        seeds_[i] = find_pixel(i).seed, samples_[i] = uint32_t(samples.first) + i % sample_count_;
        active_[i] = i;
    }
    list_wave_samples();
    sample_2d(scalar::kPixelPair, places_);
    for (size_t i = 0; i < count; ++i)
        places_[i] = Vec2f{float(find_pixel(i).x), float(find_pixel(i).y)} + places_[i];
    if (path_lights_.is_on()) path_lights_.start(paths_.size());
    rays_.resize(paths_.size());
    if (!is_pinhole())
        for (uint32_t i = 0; i < paths_.size(); ++i) {
            const scalar::CameraRay ray = scalar::aim_camera_ray(camera_, places_[i], seeds_[i], samples_[i]);
            rays_[i] = {ray.origin, 0, ray.direction, kInfinity, 0};
        }
    counters_.camera_rays += paths_.size();
}

void TileTracer::trace_paths() {
    hits_.resize(rays_.size());
    if (depth_ == 0 && is_pinhole())
        tracer_.camera_hits(camera_, places_, rays_, hits_);
    else if (depth_ == 0)
        tracer_.closest_hits(rays_, hits_);
    else
        closest_bounce_hits(tracer_, rays_, coarse_from_, hits_, depth_, bounce_scratch_, scratch_);
    if (tracer_.scene().has_cut_outs)
        pass_cut_outs(tracer_, rays_,
                      depth_ > 0 ? std::span<const float>(coarse_from_) : std::span<const float>(), hits_,
                      depth_,
                      {[&](uint32_t k, uint32_t round) { return draw_cut_out(active_[k], false, round); },
                       [&](uint32_t k, const Vec3f& left) { pass_wall(k, left); }, WallRule::by_chance},
                      cut_out_scratch_);
    if (!footprints_) return;
    for (size_t k = 0; k < rays_.size(); ++k) note_ray(active_[k], rays_[k], hits_[k].t);
}

void TileTracer::note_ray(uint32_t path, const TraceRay& ray, float t_end) {
    footprints_->at(find_pixel(path).x, find_pixel(path).y).add_ray(ray.origin, ray.direction, t_end);
}

void TileTracer::sample_2d(uint32_t pair, std::vector<Vec2f>& drawn) const {
    drawn.resize(wave_seeds_.size());
    tracer_.shading_kernels().sample_2d({wave_seeds_.data(), wave_samples_.data(), wave_seeds_.size()}, pair,
                                        drawn.data());
}

void TileTracer::list_wave_samples() {
    wave_seeds_.clear(), wave_samples_.clear();
    for (const uint32_t i : active_) wave_seeds_.push_back(seeds_[i]), wave_samples_.push_back(samples_[i]);
}

/// The roulette's pair only where it is needed.
void TileTracer::draw_random() {
    list_wave_samples();
    const bool needs_roulette = uint32_t(depth_) >= scalar::kRouletteDepth || lights_.needs_emitter_number();
    for (const uint32_t kind :
         {scalar::kPickPair, scalar::kLightPair, scalar::kBsdfPair, scalar::kRoulettePair}) {
        if (kind == scalar::kRoulettePair && !needs_roulette)
            random_[kind].assign(active_.size(), Vec2f{});
        else
            sample_2d(scalar::find_bounce_pair(uint32_t(depth_), kind), random_[kind]);
    }
}

/// Of rays that met something, some meet cut-outs alone that let them through.
void TileTracer::pass_shadow_rays() {
    stopped_.clear(), stopped_rays_.clear();
    for (uint32_t k = 0; k < shadow_rays_.size(); ++k)
        if (occluded_[k]) stopped_.push_back(k), stopped_rays_.push_back(shadow_rays_[k]);
    stoppers_.resize(stopped_.size());
    tracer_.continued_hits(stopped_rays_, stoppers_, depth_);
    const auto get_shadow = [&](uint32_t n) -> ShadowRay& { return shadows_[stopped_[n]]; };
    const auto pass = [&](uint32_t n, const Vec3f& left) {
        get_shadow(n).contribution = get_shadow(n).contribution * left;
    };
    const auto draw = [&](uint32_t n, uint32_t round) {
        return draw_cut_out(get_shadow(n).path, true, round);
    };
    pass_cut_outs(tracer_, stopped_rays_, {}, stoppers_, depth_, {draw, pass, WallRule::by_weight},
                  cut_out_scratch_);
    for (size_t n = 0; n < stopped_.size(); ++n) occluded_[stopped_[n]] = stoppers_[n].is_hit() ? 1 : 0;
}

/// What shadow ray `k` brings, which nothing is in the way of.
void TileTracer::add_shadow_light(size_t k) {
    const auto& [path, light] = shadows_[k];
    if (has_catchers_ && first_hits_[path].shadow.x > 0) {
        first_hits_[path].shadow.y += scalar::luminance(light);
        return;
    }
    paths_[path].radiance += light;
    if (path_lights_.is_on()) path_lights_.add_shadow_light(k, path, light, uint32_t(depth_));
}

void TileTracer::trace_shadow_rays() {
    occluded_.assign(shadow_rays_.size(), 0);
    any_scattered_hits(tracer_, shadow_rays_, occluded_, depth_, bounce_scratch_.order);
    if (tracer_.scene().has_cut_outs) pass_shadow_rays();
    if (footprints_)
        for (size_t k = 0; k < shadows_.size(); ++k)
            note_ray(shadows_[k].path, shadow_rays_[k], shadow_rays_[k].t_max);
    for (size_t k = 0; k < shadows_.size(); ++k)
        if (!occluded_[k]) add_shadow_light(k);
    counters_.shadow_rays += shadow_rays_.size();
}

void trace_tile(const PathTracerScene& scene, Film& film, const Window& tile, SampleRange samples,
                TileReport& report) {
    TileTracer tracer(scene, film, tile, report);
    const int end = samples.first + samples.count;
    for (int k = samples.first; k < end; k += TileTracer::kMostSamples)
        tracer.trace_samples({k, std::min(TileTracer::kMostSamples, end - k)});
}

} // namespace relief::cpu
