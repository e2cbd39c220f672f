#include "cpu/path_tracer.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <vector>

#include "base/timer.h"
#include "cpu/bounce_rays.h"
#include "cpu/cut_outs.h"
#include "cpu/glass_paths.h"
#include "cpu/path_lights.h"
#include "cpu/shading/normal_maps.h"
#include "cpu/shading/vertex_access.h"
#include "formulas/camera.h"
#include "formulas/glass.h"
#include "formulas/light.h"
#include "formulas/light_tree.h"
#include "formulas/path.h"
#include "formulas/sobol.h"
#include "prepare/bounce_lod.h"
#include "prepare/camera_frame.h"

namespace relief::cpu {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kPacketEdge = 4;

/// What a path brings from vertex to vertex; its ray and hit are in the wave.
struct Path {
    Vec3f throughput{1, 1, 1};
    scalar::LitPoint previous{}; ///< the vertex that the ray left
    float bsdf_pdf = 0;          ///< with which the ray was drawn there
    uint32_t body = kNoIndex;    ///< of solid glass that the ray is in: record of PreparedScene::glass
    int x = 0, y = 0;
    FilmSample result;
};

/// `diffuse`: of light along `direction`. What comes from behind a surface is transmitted.
scalar::LightShares find_shares(const VertexLanes& lanes, size_t lane, const float (&diffuse)[3][16],
                                const Vec3f& direction) {
    const bool is_behind = dot(get_lane(lanes.geometric_normal, lane), direction) < 0;
    return {get_lane(diffuse, lane), is_behind ? scalar::kLobeTransmission : scalar::kLobeSpecular};
}

struct ShadowRay {
    uint32_t path;
    Vec3f contribution;
};

/// The wavefront of one tile: all paths of a sample advance together, so that rays and hits reach the SIMD
/// kernels in packets. Entry k of the wave's arrays belongs to the path active_[k].
class TileTracer {
  public:
    TileTracer(const PathTracerScene& scene, Film& film, const Window& tile, TileReport& report);
    void trace_sample(int index);

  private:
    bool is_pinhole() const { return camera_.aperture_radius == 0; }
    void start_paths();
    void trace_paths();
    float draw_cut_out(uint32_t path, bool is_shadow, uint32_t round) const {
        return scalar::draw_cut_out(seeds_[path], sample_index_, uint32_t(depth_), is_shadow ? 1 : 0, round);
    }
    void pass_shadow_rays();
    void note_ray(const Path& path, const TraceRay& ray, float t_end);
    void shade_paths();
    void add_backgrounds();
    void add_background(uint32_t path, const Vec3f& light);
    void gather_lights();
    void add_lights_before(size_t k, const Vec3f& share, const EnvironmentLookup& behind);
    void drop_misses();
    void draw_random();
    void sample_2d(std::span<const uint32_t> seeds, uint32_t pair, std::vector<Vec2f>& drawn) const;
    size_t shade_block(size_t first, size_t count, size_t next);
    void draw_lights(size_t first, size_t count);
    void reflect(size_t first, size_t count);
    const scalar::GlassParameters* find_body(uint32_t body) const {
        return body == kNoIndex ? nullptr : &tracer_.scene().glass.records[body];
    }
    void pass_wall(size_t k, const Vec3f& left);
    uint32_t choose_body(size_t k, const VertexLanes& lanes, size_t lane, const Vec3f& direction) const;
    void record_first_hit(size_t k, const VertexLanes& lanes, size_t lane);
    Vec3f add_found_light(uint32_t path, const Vec3f& light);
    void add_emission(size_t k, const Vec3f& emission);
    void add_shadow_ray(size_t k, const VertexLanes& lanes, size_t lane, const LightSample& light);
    bool continue_path(size_t k, const VertexLanes& lanes, size_t lane, size_t next);
    void trace_shadow_rays();

    static constexpr size_t kBlock = 64; ///< vertices that are at work at once: as many as a cache holds

    const Tracer& tracer_;
    const LightSet& lights_;
    const RenderSettings& settings_;
    Film& film_;
    TileCounters& counters_;
    PictureFootprints* footprints_;
    const bool has_glass_;
    scalar::CameraFrame camera_;
    scalar::BounceLod bounce_lod_;
    uint32_t sample_index_ = 0;
    int depth_ = 0;               ///< vertices behind the wave: 0 for camera rays
    std::vector<Path> paths_;     ///< in packets of kPacketEdge squared pixels
    std::vector<uint32_t> seeds_; ///< of the pixels of paths_

    std::vector<uint32_t> active_; ///< paths still on their way, in order
    std::vector<TraceRay> rays_;
    std::vector<float> coarse_from_; ///< see closest_bounce_hits; of bounce rays
    std::vector<TraceHit> hits_;
    std::vector<Vec2f> places_; ///< of camera rays in the picture, in pixels
    std::vector<uint32_t> missed_;
    std::vector<Vec3f> directions_; ///< of rays that missed
    std::vector<EnvironmentLookup> backgrounds_;
    std::vector<SurfacePoint> points_;
    std::vector<uint32_t> wave_seeds_;
    std::array<std::vector<Vec2f>, scalar::kPairsPerBounce> random_; ///< by kind of pair

    std::array<VertexLanes, kBlock / 16> lanes_{};
    std::array<Vec3f, kBlock> emissions_;
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

TileTracer::TileTracer(const PathTracerScene& scene, Film& film, const Window& tile, TileReport& report)
    : tracer_(scene.tracer),
      lights_(scene.lights),
      settings_(scene.settings),
      film_(film),
      counters_(report.counters),
      footprints_(report.footprints),
      has_glass_(!scene.tracer.scene().glass.empty()),
      camera_(make_camera_frame(scene.tracer.scene())),
      bounce_lod_(make_bounce_lod(scene.tracer.scene(), scene.settings)),
      path_lights_(film.light_layers(), scene.tracer.scene().light_groups, scene.settings.image) {
    for (int y0 = tile.y0; y0 < tile.y1; y0 += kPacketEdge)
        for (int x0 = tile.x0; x0 < tile.x1; x0 += kPacketEdge)
            for (int y = y0; y < std::min(y0 + kPacketEdge, tile.y1); ++y)
                for (int x = x0; x < std::min(x0 + kPacketEdge, tile.x1); ++x) {
                    Path path;
                    path.x = x, path.y = y;
                    paths_.push_back(path);
                    seeds_.push_back(scalar::make_pixel_seed(settings_.image.seed, uint32_t(x), uint32_t(y)));
                }
}

void TileTracer::trace_sample(int index) {
    sample_index_ = uint32_t(index);
    start_paths();
    for (depth_ = 0; !active_.empty(); ++depth_) {
        trace_paths();
        shade_paths();
        trace_shadow_rays();
    }
    const Timer timer;
    for (const Path& path : paths_) film_.add_sample(path.x, path.y, path.result);
    if (path_lights_.is_on())
        for (uint32_t i = 0; i < paths_.size(); ++i)
            film_.add_lights(paths_[i].x, paths_[i].y, path_lights_.at(i));
    counters_.film_s += timer.seconds();
}

void TileTracer::start_paths() {
    sample_2d(seeds_, scalar::kPixelPair, places_);
    active_.resize(paths_.size());
    for (uint32_t i = 0; i < paths_.size(); ++i) {
        Path& path = paths_[i];
        places_[i] = Vec2f{float(path.x), float(path.y)} + places_[i];
        path.throughput = {1, 1, 1};
        path.body = kNoIndex;
        path.result = {};
        path.result.cost = 1;
        active_[i] = i;
    }
    if (path_lights_.is_on()) path_lights_.start(paths_.size());
    rays_.resize(paths_.size());
    if (!is_pinhole())
        for (size_t i = 0; i < paths_.size(); ++i) {
            const scalar::CameraRay ray =
                scalar::aim_camera_ray(camera_, places_[i], seeds_[i], sample_index_);
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
    for (size_t k = 0; k < rays_.size(); ++k) note_ray(paths_[active_[k]], rays_[k], hits_[k].t);
}

void TileTracer::note_ray(const Path& path, const TraceRay& ray, float t_end) {
    footprints_->at(path.x, path.y).add_ray(ray.origin, ray.direction, t_end);
}

void TileTracer::shade_paths() {
    const Timer timer;
    shadow_rays_.clear(), shadows_.clear(), path_lights_.clear_shadow_rays();
    add_backgrounds();
    drop_misses();
    points_.resize(hits_.size()), coarse_from_.resize(hits_.size());
    tracer_.make_surface_points(hits_, points_, scratch_);
    if (tracer_.scene().has_normal_maps) map_shading_normals(tracer_.scene(), hits_, points_);
    draw_random();
    size_t next = 0;
    for (size_t first = 0; first < active_.size(); first += kBlock)
        next = shade_block(first, std::min(kBlock, active_.size() - first), next);
    active_.resize(next), rays_.resize(next), coarse_from_.resize(next);
    counters_.bounce_rays += active_.size();
    counters_.shade_s += timer.seconds();
}

/// Light of rays that leave the scene, and of analytic lights that are met on the way.
void TileTracer::add_backgrounds() {
    missed_.resize(active_.size()), directions_.resize(active_.size());
    size_t count = 0;
    for (uint32_t k = 0; k < active_.size(); ++k) {
        missed_[count] = k, directions_[count] = rays_[k].direction;
        count += hits_[k].is_hit() ? 0 : 1; // branchless: unpredictable
    }
    missed_.resize(count), directions_.resize(count), backgrounds_.resize(count);
    if (depth_ == 0 && lights_.has_visible_lights())
        for (size_t k = 0; k < active_.size(); ++k) add_lights_before(k, paths_[active_[k]].throughput, {});
    const auto add = [&](size_t n, const Vec3f& light) { add_background(active_[missed_[n]], light); };
    if (depth_ == 0 && settings_.image.background) {
        // Lights cover the background of the picture, which is none of the scene.
        for (size_t n = 0; n < count; ++n)
            if (paths_[active_[missed_[n]]].result.alpha == 0) add(n, *settings_.image.background);
        return;
    }
    lights_.look_up_environment(directions_, backgrounds_);
    if (depth_ > 0) return gather_lights();
    for (size_t n = 0; n < count; ++n) add(n, backgrounds_[n].radiance);
}

/// What the camera sees behind all surfaces; less of it than there is through clear walls.
void TileTracer::add_background(uint32_t path, const Vec3f& light) {
    const Vec3f seen = paths_[path].throughput * light;
    paths_[path].result.radiance += seen;
    if (path_lights_.is_on()) path_lights_.add_background(path, settings_.image.background.has_value(), seen);
}

/// Misses look up the image at places far apart, hits do not; both meet analytic lights, which are rare.
void TileTracer::gather_lights() {
    for (size_t n = 0; n < missed_.size(); ++n) {
        const size_t k = missed_[n];
        add_lights_before(k, paths_[active_[k]].throughput, backgrounds_[n]);
    }
    if (!lights_.has_analytic_lights()) return;
    for (size_t k = 0; k < active_.size(); ++k)
        if (hits_[k].is_hit()) add_lights_before(k, paths_[active_[k]].throughput, {});
}

/// Of what ray k meets before hits_[k] and, where that is nothing, behind it; `share` comes to the camera.
void TileTracer::add_lights_before(size_t k, const Vec3f& share, const EnvironmentLookup& behind) {
    const uint32_t index = active_[k];
    Path& path = paths_[index];
    if (depth_ == 0) {
        const LightSet::Sight seen = lights_.see(rays_[k].origin, rays_[k].direction, hits_[k].t);
        path.result.radiance += share * seen.radiance;
        if (seen.is_met) path.result.alpha = 1;
        if (path_lights_.is_on()) path_lights_.add_seen_lights(index, lights_, rays_[k], hits_[k].t, share);
        return;
    }
    const LightSet::BounceRay ray{path.previous, rays_[k].direction, hits_[k].t, path.bsdf_pdf,
                                  find_body(path.body)};
    const Vec3f light = share * lights_.evaluate_mis(ray, behind);
    add_found_light(index, light);
    if (path_lights_.has_groups())
        path_lights_.add_met_lights(index, {lights_, ray, behind, share, light}, depth_);
}

/// The path goes on behind a clear wall; what lies before it has shone through none.
void TileTracer::pass_wall(size_t k, const Vec3f& left) {
    Vec3f& throughput = paths_[active_[k]].throughput;
    const Vec3f whole = throughput;
    throughput = throughput * left;
    if (depth_ == 0 ? lights_.has_visible_lights() : lights_.has_analytic_lights())
        add_lights_before(k, whole - throughput, {});
}

void TileTracer::drop_misses() {
    size_t kept = 0;
    for (size_t k = 0; k < active_.size(); ++k)
        if (hits_[k].is_hit())
            active_[kept] = active_[k], rays_[kept] = rays_[k], hits_[kept] = hits_[k], ++kept;
    active_.resize(kept), rays_.resize(kept), hits_.resize(kept);
}

void TileTracer::sample_2d(std::span<const uint32_t> seeds, uint32_t pair, std::vector<Vec2f>& drawn) const {
    drawn.resize(seeds.size());
    tracer_.shading_kernels().sample_2d(seeds.data(), seeds.size(), sample_index_, pair, drawn.data());
}

/// The roulette's pair only where it is needed.
void TileTracer::draw_random() {
    wave_seeds_.clear();
    for (const uint32_t i : active_) wave_seeds_.push_back(seeds_[i]);
    const bool needs_roulette = uint32_t(depth_) >= scalar::kRouletteDepth || lights_.needs_emitter_number();
    for (const uint32_t kind :
         {scalar::kPickPair, scalar::kLightPair, scalar::kBsdfPair, scalar::kRoulettePair}) {
        if (kind == scalar::kRoulettePair && !needs_roulette)
            random_[kind].assign(active_.size(), Vec2f{});
        else
            sample_2d(wave_seeds_, scalar::find_bounce_pair(uint32_t(depth_), kind), random_[kind]);
    }
}

/// Vertices of the wave from `first` on. Paths that go on get the places from `next`; what lies before a
/// block has been shaded, so that its place can be taken. Returns the next place.
size_t TileTracer::shade_block(size_t first, size_t count, size_t next) {
    draw_lights(first, count);
    reflect(first, count);
    std::array<uint32_t, kBlock> lit;
    size_t lit_count = 0;
    for (size_t n = 0; n < count; ++n) {
        lit[lit_count] = uint32_t(n);
        lit_count += lanes_[n / 16].needs_shadow_ray >> n % 16 & 1;
    }
    lights_.complete_weight(lights_drawn_, {lit.data(), lit_count});
    for (size_t n = 0; n < count; ++n) {
        if (depth_ == 0) record_first_hit(first + n, lanes_[n / 16], n % 16);
        if (!(emissions_[n] == Vec3f{})) add_emission(first + n, emissions_[n]);
    }
    for (size_t n = 0; n < lit_count; ++n)
        add_shadow_ray(first + lit[n], lanes_[lit[n] / 16], lit[n] % 16, lights_drawn_[lit[n]]);
    for (size_t n = 0; n < count; ++n)
        if (lanes_[n / 16].has_bounce >> n % 16 & 1)
            next += continue_path(first + n, lanes_[n / 16], n % 16, next) ? 1 : 0;
    return next;
}

/// A light for each vertex of a block.
void TileTracer::draw_lights(size_t first, size_t count) {
    for (size_t n = 0; n < count; ++n) {
        const size_t k = first + n;
        const Vec3f& normal = points_[k].geometric_normal;
        const bool is_seen_from_behind = dot(normal, rays_[k].direction) > 0;
        receivers_[n] = {points_[k].position, hits_[k].lod_bias, is_seen_from_behind ? -normal : normal,
                         points_[k].instance};
        light_random_[n] = {random_[scalar::kPickPair][k].x, random_[scalar::kRoulettePair][k].y,
                            random_[scalar::kLightPair][k]};
    }
    lights_.draw({receivers_.data(), count}, {light_random_.data(), count}, {lights_drawn_.data(), count});
}

/// Of solid glass that a ray from a vertex goes into.
uint32_t TileTracer::choose_body(size_t k, const VertexLanes& lanes, size_t lane,
                                 const Vec3f& direction) const {
    const uint32_t record = lanes.has_glass >> lane & 1 ? lanes.glass[lane] : kNoIndex;
    return find_next_body(tracer_.scene().glass,
                          {paths_[active_[k]].body, record, dot(points_[k].geometric_normal, direction),
                           dot(get_lane(lanes.geometric_normal, lane), direction) < 0});
}

/// Fills lanes_ for a block whose lights are drawn.
void TileTracer::reflect(size_t first, size_t count) {
    const PreparedScene& scene = tracer_.scene();
    for (size_t n = 0; n < count; ++n) {
        const size_t k = first + n;
        const SurfacePoint& point = points_[k];
        PointMaterial m = make_point_material(scene, hits_[k].instance, point.uv);
        if (has_glass_) {
            Path& path = paths_[active_[k]];
            const GlassArrival arrival{dot(point.geometric_normal, rays_[k].direction), hits_[k].t};
            path.throughput = path.throughput *
                              meet_glass(scene.glass, arrival, path.body, m, random_[scalar::kPickPair][k].y);
        }
        VertexLanes& lanes = lanes_[n / 16];
        const size_t lane = n % 16;
        set_material(m, lane, lanes);
        emissions_[n] = m.emission;
        set_lane(lights_drawn_[n].direction, lane, lanes.light_direction);
        lanes.light_pdf[lane] = lights_drawn_[n].pdf;
    }
    for (size_t n = count; n % 16 != 0; ++n) set_plain(n % 16, lanes_[n / 16]);
    const bool has_bounce = depth_ < settings_.image.bounces;
    const MaterialLayers& found = scene.layers;
    const LayerView layers{found.records.data(), found.entries.data(), uint32_t(found.entries.size())};
    for (size_t n = 0; n < count; n += 16) {
        const size_t k = first + n;
        tracer_.shading_kernels().reflect(
            {.count = std::min(size_t(16), count - n),
             .points = &points_[k],
             .rays = &rays_[k],
             .pick_pairs = has_bounce ? &random_[scalar::kPickPair][k] : nullptr,
             .bsdf_pairs = has_bounce ? &random_[scalar::kBsdfPair][k] : nullptr,
             .layers = layers,
             .glass = scene.glass.records.data(),
             .wants_diffuse_shares = depth_ == 0 && path_lights_.has_kinds()},
            lanes_[n / 16]);
    }
}

void TileTracer::record_first_hit(size_t k, const VertexLanes& lanes, size_t lane) {
    FilmSample& result = paths_[active_[k]].result;
    result.alpha = 1;
    result.depth = hits_[k].t;
    result.shading_normal = get_lane(lanes.shading_normal, lane);
    result.geometric_normal = get_lane(lanes.geometric_normal, lane);
    result.position = points_[k].position;
    result.albedo = get_lane(lanes.base_color, lane);
    result.uv = points_[k].uv;
    result.id = points_[k].instance + 1;
}

/// What a ray of the path met by chance: at the first vertex after a bounce it is direct light.
Vec3f TileTracer::add_found_light(uint32_t path, const Vec3f& light) {
    const uint32_t bounces = uint32_t(std::max(depth_ - 1, 0));
    const Vec3f found = scalar::clamp_indirect(light, settings_.image.clamp_indirect, bounces);
    paths_[path].result.radiance += found;
    if (depth_ > 0) path_lights_.add_scattered(path, found, bounces);
    return found;
}

void TileTracer::add_emission(size_t k, const Vec3f& emission) {
    const Path& path = paths_[active_[k]];
    const float light_pdf = depth_ > 0 ? lights_.emitter_pdf(path.previous, points_[k]) : 0.0f;
    const float weight = depth_ > 0 ? scalar::power_heuristic(path.bsdf_pdf, light_pdf) : 1.0f;
    const Vec3f found = add_found_light(active_[k], path.throughput * emission * weight);
    if (path_lights_.is_on())
        path_lights_.add_emission(active_[k], tracer_.scene().instances[hits_[k].instance].material, found,
                                  depth_);
}

/// Next-event estimation. At the last vertex no bounce ray can find the light too: full weight.
void TileTracer::add_shadow_ray(size_t k, const VertexLanes& lanes, size_t lane, const LightSample& light) {
    Path& path = paths_[active_[k]];
    const bool is_last = depth_ == settings_.image.bounces;
    const float weight = is_last ? 1.0f : scalar::power_heuristic(light.pdf, lanes.light_bsdf_pdf[lane]);
    Vec3f contribution = path.throughput * get_lane(lanes.light_reflected, lane) * light.weight * weight;
    if (contribution == Vec3f{} || !is_finite(contribution)) return;
    TraceRay ray{get_lane(lanes.shadow_origin, lane), 0, light.direction, light.distance, hits_[k].lod_bias};
    if (light.emitter) {
        const Vec3f to = tracer_.offset_origin(*light.emitter, -light.direction) - ray.origin;
        ray.t_max = length(to) * (1 - 1e-6f);
        ray.direction = normalize(to);
    }
    if (has_glass_)
        if (const auto* body = find_body(choose_body(k, lanes, lane, ray.direction)))
            contribution = contribution * scalar::absorb_along(body->depth, ray.t_max);
    shadow_rays_.push_back(ray);
    shadows_.push_back(
        {active_[k], scalar::clamp_indirect(contribution, settings_.image.clamp_indirect, uint32_t(depth_))});
    if (path_lights_.is_on())
        path_lights_.add_shadow_ray(
            {find_shares(lanes, lane, lanes.light_diffuse, light.direction), light.group});
    path.result.cost += 1;
}

bool TileTracer::continue_path(size_t k, const VertexLanes& lanes, size_t lane, size_t next) {
    Path& path = paths_[active_[k]];
    path.throughput = path.throughput * get_lane(lanes.bounce_weight, lane);
    const Vec3f direction = get_lane(lanes.bounce_direction, lane);
    if (has_glass_) path.body = choose_body(k, lanes, lane, direction);
    const auto* body = find_body(path.body);
    const float probability = scalar::survival_probability(
        uint32_t(depth_), body ? path.throughput * (body->ior * body->ior) : path.throughput);
    if (!is_finite(path.throughput) || random_[scalar::kRoulettePair][k].x >= probability) return false;
    path.throughput *= 1 / probability;
    path.previous = {points_[k].position, get_lane(lanes.geometric_normal, lane), points_[k].instance};
    path.bsdf_pdf = lanes.bounce_pdf[lane];
    path.result.cost += 1;
    if (depth_ == 0)
        path_lights_.set_shares(active_[k], find_shares(lanes, lane, lanes.bounce_diffuse, direction));
    active_[next] = active_[k];
    rays_[next] = {get_lane(lanes.bounce_origin, lane), 0, direction, kInfinity, uint32_t(hits_[k].lod_bias)};
    // A body is left on the surface that it was entered on: between the two there would be no way out.
    coarse_from_[next] = body ? kInfinity
                              : scalar::find_coarse_distance(bounce_lod_, rays_[next].origin,
                                                             rays_[next].lod_bias, path.bsdf_pdf);
    return true;
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

void TileTracer::trace_shadow_rays() {
    occluded_.assign(shadow_rays_.size(), 0);
    tracer_.any_hits(shadow_rays_, occluded_, depth_);
    if (tracer_.scene().has_cut_outs) pass_shadow_rays();
    if (footprints_)
        for (size_t k = 0; k < shadows_.size(); ++k)
            note_ray(paths_[shadows_[k].path], shadow_rays_[k], shadow_rays_[k].t_max);
    for (size_t k = 0; k < shadows_.size(); ++k)
        if (!occluded_[k]) paths_[shadows_[k].path].result.radiance += shadows_[k].contribution;
    for (size_t k = 0; path_lights_.is_on() && k < shadows_.size(); ++k)
        if (!occluded_[k])
            path_lights_.add_shadow_light(k, shadows_[k].path, shadows_[k].contribution, uint32_t(depth_));
    counters_.shadow_rays += shadow_rays_.size();
}

} // namespace

void trace_tile(const PathTracerScene& scene, Film& film, const Window& tile, SampleRange samples,
                TileReport& report) {
    TileTracer tracer(scene, film, tile, report);
    for (int k = samples.first; k < samples.first + samples.count; ++k) tracer.trace_sample(k);
}

} // namespace relief::cpu
