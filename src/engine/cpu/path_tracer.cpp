#include "engine/cpu/path_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "base/timer.h"
#include "engine/camera_frame.h"
#include "engine/cpu/shading_kernels.h"
#include "engine/cpu/textures.h"
#include "math/scalar.h"

namespace relief::cpu {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kPacketEdge = 4;

/// What a path brings from vertex to vertex; its ray and hit are in the wave.
struct Path {
    Vec3f throughput{1, 1, 1};
    Vec3f previous{};   ///< the vertex that the ray left
    float bsdf_pdf = 0; ///< with which the ray was drawn there
    int x = 0, y = 0;
    FilmSample result;
};

/// A material at one point, textures looked up.
struct PointMaterial {
    Vec3f base_color, emission;
    float roughness, metallic, ior;
};

/// A hit made ready for shading; normals on the viewer's side.
struct Vertex {
    SurfacePoint point;
    uint32_t bias;  ///< of the surface that was hit
    float distance; ///< that the ray came
    PointMaterial material;
    scalar::Basis basis; ///< about the bent shading normal
    Vec3f wo_local;
    scalar::Bsdf bsdf;
};

struct ShadowRay {
    uint32_t path;
    Vec3f contribution;
};

/// The wavefront of one tile: all paths of one sample advance together, so that their rays go to the tracer
/// in packets and their hits to the kernels of shading. Entry k of the wave's arrays belongs to the path
/// active_[k].
class TileTracer {
  public:
    TileTracer(const PathTracerScene& scene, Film& film, const Window& tile, TileReport& report);
    void trace_sample(int index);

  private:
    bool is_pinhole() const { return camera_.aperture_radius == 0; }
    void start_paths();
    void trace_paths();
    void note_ray(const Path& path, const TraceRay& ray, float t_end);
    void shade_paths();
    void add_backgrounds();
    void gather_lights();
    void drop_misses();
    void draw_random();
    void draw_pairs(std::span<const uint32_t> seeds, uint32_t pair, std::vector<Vec2f>& drawn) const;
    void start_vertices(size_t first, size_t count);
    Vertex make_vertex(size_t k) const;
    PointMaterial make_material(uint32_t instance, const Vec2f& uv) const;
    bool shade_path(size_t k, const Vertex& vertex, const std::optional<LightSample>& light, size_t next);
    void record_first_hit(Path& path, const Vertex& vertex) const;
    void add_emission(Path& path, const Vertex& vertex) const;
    void sample_light(uint32_t index, const Vertex& vertex, const LightSample& light);
    bool continue_path(size_t k, const Vertex& vertex, size_t next);
    bool survives_roulette(Path& path, float u_roulette) const;
    void trace_shadow_rays();
    void finish_paths();

    static constexpr size_t kBlock = 32; ///< vertices that are at work at once: as many as a cache holds

    const Tracer& tracer_;
    const LightSet& lights_;
    const RenderSettings& settings_;
    Film& film_;
    TileCounters& counters_;
    PictureFootprints* footprints_;
    scalar::CameraFrame camera_;
    uint32_t sample_index_ = 0;
    int depth_ = 0;               ///< vertices behind the wave: 0 for camera rays
    std::vector<Path> paths_;     ///< in packets of kPacketEdge squared pixels
    std::vector<uint32_t> seeds_; ///< of the pixels of paths_

    std::vector<uint32_t> active_; ///< paths still on their way, in order
    std::vector<TraceRay> rays_;
    std::vector<TraceHit> hits_;
    std::vector<Vec2f> places_; ///< in the environment's image, of rays that hit nothing
    std::vector<SurfacePoint> points_;
    std::vector<uint32_t> wave_seeds_;
    std::array<std::vector<Vec2f>, scalar::kPairsPerBounce> random_; ///< by kind of pair

    std::array<Vertex, kBlock> vertices_;
    std::array<LightSet::Receiver, kBlock> receivers_;
    std::array<LightSet::RandomNumbers, kBlock> light_random_;
    std::array<std::optional<LightSample>, kBlock> lights_drawn_;

    std::vector<TraceRay> shadow_rays_;
    std::vector<ShadowRay> shadows_; ///< what each shadow ray brings if nothing is in its way
    std::vector<uint8_t> occluded_;
    PointScratch scratch_;
};

TileTracer::TileTracer(const PathTracerScene& scene, Film& film, const Window& tile, TileReport& report)
    : tracer_(scene.tracer),
      lights_(scene.lights),
      settings_(scene.settings),
      film_(film),
      counters_(report.counters),
      footprints_(report.footprints),
      camera_(make_camera_frame(scene.tracer.scene())) {
    for (int y0 = tile.y0; y0 < tile.y1; y0 += kPacketEdge)
        for (int x0 = tile.x0; x0 < tile.x1; x0 += kPacketEdge)
            for (int y = y0; y < std::min(y0 + kPacketEdge, tile.y1); ++y)
                for (int x = x0; x < std::min(x0 + kPacketEdge, tile.x1); ++x) {
                    Path path;
                    path.x = x, path.y = y;
                    paths_.push_back(path);
                    seeds_.push_back(scalar::make_pixel_seed(settings_.seed, uint32_t(x), uint32_t(y)));
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
    finish_paths();
}

void TileTracer::start_paths() {
    draw_pairs(seeds_, scalar::kPixelPair, places_);
    active_.resize(paths_.size());
    for (uint32_t i = 0; i < paths_.size(); ++i) {
        Path& path = paths_[i];
        places_[i] = Vec2f{float(path.x), float(path.y)} + places_[i];
        path.throughput = {1, 1, 1};
        path.result = {};
        path.result.cost = 1;
        active_[i] = i;
    }
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
    else
        tracer_.closest_hits(rays_, hits_, depth_);
    if (!footprints_) return;
    for (size_t k = 0; k < rays_.size(); ++k) note_ray(paths_[active_[k]], rays_[k], hits_[k].t);
}

void TileTracer::note_ray(const Path& path, const TraceRay& ray, float t_end) {
    footprints_->at(path.x, path.y).add_ray(ray.origin, ray.direction, t_end);
}

void TileTracer::shade_paths() {
    const Timer timer;
    shadow_rays_.clear(), shadows_.clear();
    add_backgrounds();
    drop_misses();
    points_.resize(hits_.size());
    tracer_.make_surface_points(hits_, points_, scratch_);
    draw_random();
    size_t next = 0;
    for (size_t first = 0; first < active_.size(); first += kBlock) {
        const size_t count = std::min(kBlock, active_.size() - first);
        start_vertices(first, count);
        for (size_t k = 0; k < count; ++k)
            if (shade_path(first + k, vertices_[k], lights_drawn_[k], next)) ++next;
    }
    active_.resize(next), rays_.resize(next);
    counters_.bounce_rays += active_.size();
    counters_.shade_s += timer.seconds();
}

/// Light of rays that leave the scene, and of lamps that are met on the way.
void TileTracer::add_backgrounds() {
    if (depth_ > 0) return gather_lights();
    for (size_t k = 0; k < active_.size(); ++k)
        if (!hits_[k].is_hit())
            paths_[active_[k]].result.radiance +=
                lights_.environment_radiance(lights_.locate_environment(rays_[k].direction));
}

/// Of bounce rays, which look at places of the image far apart. It is read in a loop of its own: waits for
/// memory overlap.
void TileTracer::gather_lights() {
    places_.resize(active_.size());
    for (size_t k = 0; k < active_.size(); ++k) {
        if (hits_[k].is_hit()) continue;
        places_[k] = lights_.locate_environment(rays_[k].direction);
        lights_.prefetch_environment(places_[k]);
    }
    for (size_t k = 0; k < active_.size(); ++k) {
        Path& path = paths_[active_[k]];
        path.result.radiance +=
            path.throughput *
            lights_.gather({path.previous, rays_[k].direction, hits_[k].t, path.bsdf_pdf}, places_[k]);
    }
}

void TileTracer::drop_misses() {
    size_t kept = 0;
    for (size_t k = 0; k < active_.size(); ++k)
        if (hits_[k].is_hit())
            active_[kept] = active_[k], rays_[kept] = rays_[k], hits_[kept] = hits_[k], ++kept;
    active_.resize(kept), rays_.resize(kept), hits_.resize(kept);
}

void TileTracer::draw_pairs(std::span<const uint32_t> seeds, uint32_t pair, std::vector<Vec2f>& drawn) const {
    drawn.resize(seeds.size());
    tracer_.shading_kernels().draw_pairs(seeds.data(), seeds.size(), sample_index_, pair, drawn.data());
}

/// The roulette's pair only where it is needed.
void TileTracer::draw_random() {
    wave_seeds_.clear();
    for (const uint32_t i : active_) wave_seeds_.push_back(seeds_[i]);
    const bool needs_roulette = uint32_t(depth_) >= scalar::kRouletteDepth || lights_.has_emitters();
    for (const uint32_t kind :
         {scalar::kPickPair, scalar::kLightPair, scalar::kBsdfPair, scalar::kRoulettePair}) {
        if (kind == scalar::kRoulettePair && !needs_roulette)
            random_[kind].assign(active_.size(), Vec2f{});
        else
            draw_pairs(wave_seeds_, scalar::find_bounce_pair(uint32_t(depth_), kind), random_[kind]);
    }
}

/// Vertices of the wave from `first` on, each with a light drawn.
void TileTracer::start_vertices(size_t first, size_t count) {
    for (size_t k = 0; k < count; ++k) {
        vertices_[k] = make_vertex(first + k);
        const SurfacePoint& point = vertices_[k].point;
        receivers_[k] = {point.position, point.geometric_normal, vertices_[k].bias};
        light_random_[k] = {random_[scalar::kPickPair][first + k].x,
                            random_[scalar::kRoulettePair][first + k].y,
                            random_[scalar::kLightPair][first + k]};
    }
    lights_.draw({receivers_.data(), count}, {light_random_.data(), count}, {lights_drawn_.data(), count});
}

Vertex TileTracer::make_vertex(size_t k) const {
    Vertex v;
    v.point = points_[k];
    v.bias = hits_[k].bias, v.distance = hits_[k].t;
    v.material = make_material(hits_[k].instance, v.point.uv);
    const Vec3f wo = -rays_[k].direction;
    if (dot(v.point.geometric_normal, wo) < 0) {
        v.point.geometric_normal = -v.point.geometric_normal;
        v.point.shading_normal = -v.point.shading_normal;
    }
    v.basis = scalar::make_basis(scalar::bend_normal(v.point.shading_normal, v.point.geometric_normal, wo));
    v.wo_local = scalar::lift_viewer(scalar::to_local(v.basis, wo));
    v.bsdf = scalar::make_bsdf(
        {v.material.base_color, v.material.roughness, v.material.metallic, v.material.ior}, v.wo_local.z);
    return v;
}

PointMaterial TileTracer::make_material(uint32_t instance, const Vec2f& uv) const {
    const PreparedScene& scene = tracer_.scene();
    const Material& material = scene.materials[scene.instances[instance].material];
    PointMaterial m{material.base_color, material.emission, material.roughness, material.metallic,
                    material.ior};
    if (material.base_color_texture)
        m.base_color = m.base_color * fetch_texture(*material.base_color_texture, uv);
    if (material.roughness_texture) m.roughness *= fetch_texture(*material.roughness_texture, uv).x;
    m.base_color = scalar::limit_color(m.base_color);
    m.roughness = std::clamp(m.roughness, 0.0f, 1.0f);
    return m;
}

/// Adds the light that reaches one vertex; true when the path goes on, in place `next` of the wave.
bool TileTracer::shade_path(size_t k, const Vertex& vertex, const std::optional<LightSample>& light,
                            size_t next) {
    Path& path = paths_[active_[k]];
    if (depth_ == 0) record_first_hit(path, vertex);
    add_emission(path, vertex);
    if (light) sample_light(active_[k], vertex, *light);
    return depth_ < settings_.bounces && continue_path(k, vertex, next);
}

void TileTracer::record_first_hit(Path& path, const Vertex& vertex) const {
    path.result.alpha = 1;
    path.result.depth = vertex.distance;
    path.result.shading_normal = vertex.point.shading_normal;
    path.result.geometric_normal = vertex.point.geometric_normal;
    path.result.position = vertex.point.position;
    path.result.albedo = vertex.material.base_color;
    path.result.uv = vertex.point.uv;
    path.result.id = vertex.point.instance + 1;
}

void TileTracer::add_emission(Path& path, const Vertex& vertex) const {
    const Vec3f& emission = vertex.material.emission;
    if (emission == Vec3f{}) return;
    const float light_pdf = depth_ > 0 ? lights_.emitter_pdf(path.previous, vertex.point) : 0.0f;
    const float weight = depth_ > 0 ? scalar::power_heuristic(path.bsdf_pdf, light_pdf) : 1.0f;
    path.result.radiance += path.throughput * emission * weight;
}

/// Next-event estimation. The last vertex has no bounce ray that could find the light as well: full weight
/// there.
void TileTracer::sample_light(uint32_t index, const Vertex& vertex, const LightSample& light) {
    Path& path = paths_[index];
    const SurfacePoint& point = vertex.point;
    const Vec3f wi = scalar::to_local(vertex.basis, light.direction);
    const scalar::BsdfValue bsdf = scalar::evaluate_bsdf(vertex.bsdf, vertex.wo_local, wi);
    const bool is_last = depth_ == settings_.bounces;
    const float weight = is_last ? 1.0f : scalar::power_heuristic(light.pdf, bsdf.pdf);
    const Vec3f contribution = path.throughput * bsdf.value * light.weight * weight;
    if (contribution == Vec3f{} || !is_finite(contribution)) return;
    TraceRay ray{tracer_.offset_origin(point, light.direction), 0, light.direction, light.distance,
                 vertex.bias};
    if (light.emitter) {
        const Vec3f to = tracer_.offset_origin(*light.emitter, -light.direction) - ray.origin;
        ray.t_max = length(to) * (1 - 1e-6f);
        ray.direction = normalize(to);
    }
    shadow_rays_.push_back(ray);
    shadows_.push_back({index, contribution});
    path.result.cost += 1;
}

/// What lies before k in the wave has been shaded, so that its place can be taken.
bool TileTracer::continue_path(size_t k, const Vertex& vertex, size_t next) {
    Path& path = paths_[active_[k]];
    const scalar::BsdfSample drawn = scalar::sample_bsdf(
        vertex.bsdf, vertex.wo_local, random_[scalar::kPickPair][k].y, random_[scalar::kBsdfPair][k]);
    const Vec3f direction = normalize(scalar::from_local(vertex.basis, drawn.direction));
    if (drawn.weight == Vec3f{} || dot(vertex.point.geometric_normal, direction) <= 0) return false;
    path.throughput = path.throughput * drawn.weight;
    if (!is_finite(path.throughput) || !survives_roulette(path, random_[scalar::kRoulettePair][k].x))
        return false;
    path.previous = vertex.point.position;
    path.bsdf_pdf = drawn.pdf;
    path.result.cost += 1;
    active_[next] = active_[k];
    rays_[next] = {tracer_.offset_origin(vertex.point, direction), 0, direction, kInfinity, vertex.bias};
    return true;
}

bool TileTracer::survives_roulette(Path& path, float u_roulette) const {
    const float probability = scalar::survival_probability(uint32_t(depth_), path.throughput);
    if (u_roulette >= probability) return false;
    path.throughput *= 1 / probability;
    return true;
}

void TileTracer::trace_shadow_rays() {
    occluded_.assign(shadow_rays_.size(), 0);
    tracer_.any_hits(shadow_rays_, occluded_, depth_);
    if (footprints_)
        for (size_t k = 0; k < shadows_.size(); ++k)
            note_ray(paths_[shadows_[k].path], shadow_rays_[k], shadow_rays_[k].t_max);
    for (size_t k = 0; k < shadows_.size(); ++k)
        if (!occluded_[k]) paths_[shadows_[k].path].result.radiance += shadows_[k].contribution;
    counters_.shadow_rays += shadow_rays_.size();
}

void TileTracer::finish_paths() {
    const Timer timer;
    for (const Path& path : paths_) film_.add_sample(path.x, path.y, path.result);
    counters_.film_s += timer.seconds();
}

} // namespace

void trace_tile(const PathTracerScene& scene, Film& film, const Window& tile, SampleRange samples,
                TileReport& report) {
    TileTracer tracer(scene, film, tile, report);
    for (int k = samples.first; k < samples.first + samples.count; ++k) tracer.trace_sample(k);
}

} // namespace relief::cpu
