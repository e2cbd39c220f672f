#include "engine/cpu/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/timer.h"
#include "engine/camera_frame.h"
#include "engine/cpu/textures.h"
#include "math/scalar.h"

namespace relief::cpu {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kPacketEdge = 4;

struct Path {
    int x = 0, y = 0;
    uint32_t seed = 0; ///< of the pixel
    int depth = 0;     ///< vertices behind it: 0 for a camera ray
    TraceRay ray;
    TraceHit hit;
    Vec3f throughput{1, 1, 1};
    Vec3f previous{};   ///< the vertex that the ray left
    float bsdf_pdf = 0; ///< with which the ray was drawn there
    FilmSample result;
};

/// A hit made ready for shading; normals on the viewer's side.
struct Vertex {
    SurfacePoint point;
    bool is_flipped;     ///< the viewer is on the side opposite to the winding
    Material material;   ///< textures looked up
    scalar::Basis basis; ///< about the bent shading normal
    Vec3f wo_local;
    scalar::Bsdf bsdf;
};

/// Random numbers of one vertex.
struct VertexRandom {
    float u_light, u_lobe;
    Vec2f light, bsdf;
    float u_roulette = 0, u_emitter = 0; ///< drawn where they are needed only
};

/// A wide bounce that has started on the surface of its path's ray.
struct BounceRay {
    uint32_t path;
    bool is_flipped; ///< as of its vertex
};

struct ShadowRay {
    uint32_t path;
    Vec3f contribution;
};

/// The wavefront of one tile: all paths of one sample advance together, so that their rays go to the tracer
/// in packets.
class TileTracer {
  public:
    TileTracer(const PathTracerScene& scene, Film& film, const Window& tile, TileCounters& counters);
    void trace_sample(int index);

  private:
    void start_paths();
    void start_path(Path& path) const;
    void trace_paths(int depth);
    void shade_paths();
    bool shade_path(uint32_t index, const SurfacePoint& point);
    void add_background(Path& path) const;
    void record_first_hit(Path& path, const Vertex& vertex) const;
    void add_emission(Path& path, const Vertex& vertex) const;
    void sample_light(uint32_t index, const Vertex& vertex, const VertexRandom& random);
    void make_points();
    void coarsen_bounces();
    bool continue_path(Path& path, const Vertex& vertex, const VertexRandom& random);
    static bool survives_roulette(Path& path, float u_roulette);
    void start_bounce_ray(Path& path, const Vertex& vertex, const Vec3f& direction, bool is_wide);
    void trace_shadow_rays(int depth);
    void finish_paths();
    Vertex make_vertex(const Path& path, const SurfacePoint& point) const;
    VertexRandom draw_random(const Path& path) const;

    const Tracer& tracer_;
    const LightSet& lights_;
    const RenderSettings& settings_;
    Film& film_;
    TileCounters& counters_;
    scalar::CameraFrame camera_;
    uint32_t sample_index_ = 0;
    std::vector<Path> paths_;      ///< in packets of kPacketEdge squared pixels
    std::vector<uint32_t> active_; ///< paths still on their way, in order
    std::vector<TraceRay> rays_;
    std::vector<TraceHit> hits_;
    std::vector<TraceRay> shadow_rays_;
    std::vector<ShadowRay> shadows_; ///< what each shadow ray brings if nothing is in its way
    std::vector<uint8_t> occluded_;
    PointScratch scratch_;
    std::vector<SurfacePoint> points_; ///< of the paths in active_
    std::vector<BounceRay> bounces_;   ///< those that may start on a coarser surface
};

TileTracer::TileTracer(const PathTracerScene& scene, Film& film, const Window& tile, TileCounters& counters)
    : tracer_(scene.tracer),
      lights_(scene.lights),
      settings_(scene.settings),
      film_(film),
      counters_(counters),
      camera_(make_camera_frame(scene.tracer.scene())) {
    for (int y0 = tile.y0; y0 < tile.y1; y0 += kPacketEdge)
        for (int x0 = tile.x0; x0 < tile.x1; x0 += kPacketEdge)
            for (int y = y0; y < std::min(y0 + kPacketEdge, tile.y1); ++y)
                for (int x = x0; x < std::min(x0 + kPacketEdge, tile.x1); ++x) {
                    Path path;
                    path.x = x, path.y = y;
                    path.seed = scalar::make_pixel_seed(settings_.seed, uint32_t(x), uint32_t(y));
                    paths_.push_back(path);
                }
}

void TileTracer::trace_sample(int index) {
    sample_index_ = uint32_t(index);
    start_paths();
    for (int depth = 0; !active_.empty(); ++depth) {
        trace_paths(depth);
        shade_paths();
        trace_shadow_rays(depth);
    }
    finish_paths();
}

void TileTracer::start_paths() {
    active_.clear();
    for (uint32_t i = 0; i < paths_.size(); ++i) {
        start_path(paths_[i]);
        active_.push_back(i);
    }
    counters_.camera_rays += paths_.size();
}

void TileTracer::start_path(Path& path) const {
    const Vec2f corner{float(path.x), float(path.y)};
    const scalar::CameraRay ray = scalar::start_camera_ray(camera_, corner, path.seed, sample_index_);
    path.depth = 0;
    path.ray = {ray.origin, 0, ray.direction, kInfinity, 0};
    path.throughput = {1, 1, 1};
    path.result = {};
    path.result.cost = 1;
}

void TileTracer::trace_paths(int depth) {
    rays_.clear();
    for (uint32_t i : active_) rays_.push_back(paths_[i].ray);
    hits_.assign(active_.size(), TraceHit{});
    tracer_.closest_hits(rays_, hits_, depth);
    for (size_t k = 0; k < active_.size(); ++k) paths_[active_[k]].hit = hits_[k];
}

void TileTracer::shade_paths() {
    const Timer timer;
    shadow_rays_.clear();
    shadows_.clear();
    // The background in a short loop of its own: reads of the image, which wait for memory, overlap.
    const auto is_finished_outside = [this](uint32_t i) {
        add_background(paths_[i]);
        return !paths_[i].hit.is_hit();
    };
    active_.erase(std::remove_if(active_.begin(), active_.end(), is_finished_outside), active_.end());
    make_points();
    size_t kept = 0;
    for (size_t k = 0; k < active_.size(); ++k)
        if (shade_path(active_[k], points_[k])) active_[kept++] = active_[k];
    active_.resize(kept);
    coarsen_bounces();
    counters_.bounce_rays += active_.size();
    counters_.shade_s += timer.seconds();
}

/// Adds the light that reaches one vertex; true when the path goes on, its next ray set.
bool TileTracer::shade_path(uint32_t index, const SurfacePoint& point) {
    Path& path = paths_[index];
    const Vertex vertex = make_vertex(path, point);
    if (path.depth == 0) record_first_hit(path, vertex);
    add_emission(path, vertex);
    const VertexRandom random = draw_random(path);
    sample_light(index, vertex, random);
    return path.depth < settings_.bounces && continue_path(path, vertex, random);
}

void TileTracer::add_background(Path& path) const {
    if (path.depth > 0)
        path.result.radiance +=
            path.throughput * lights_.gather(path.previous, path.ray.direction, path.hit.t, path.bsdf_pdf);
    else if (!path.hit.is_hit())
        path.result.radiance += lights_.environment_radiance(path.ray.direction);
}

Vertex TileTracer::make_vertex(const Path& path, const SurfacePoint& point) const {
    const PreparedScene& scene = tracer_.scene();
    Vertex v;
    v.point = point;
    v.material = scene.materials[scene.instances[path.hit.instance].material];
    if (v.material.base_color_texture)
        v.material.base_color =
            v.material.base_color * fetch_texture(*v.material.base_color_texture, v.point.uv);
    if (v.material.roughness_texture)
        v.material.roughness *= fetch_texture(*v.material.roughness_texture, v.point.uv).x;
    v.material.base_color = scalar::limit_color(v.material.base_color);
    v.material.roughness = std::clamp(v.material.roughness, 0.0f, 1.0f);
    const Vec3f wo = -path.ray.direction;
    v.is_flipped = dot(v.point.geometric_normal, wo) < 0;
    if (v.is_flipped) {
        v.point.geometric_normal = -v.point.geometric_normal;
        v.point.shading_normal = -v.point.shading_normal;
    }
    v.basis = scalar::make_basis(scalar::bend_normal(v.point.shading_normal, v.point.geometric_normal, wo));
    v.wo_local = scalar::lift_viewer(scalar::to_local(v.basis, wo));
    v.bsdf = scalar::make_bsdf(
        {v.material.base_color, v.material.roughness, v.material.metallic, v.material.ior}, v.wo_local.z);
    return v;
}

void TileTracer::record_first_hit(Path& path, const Vertex& vertex) const {
    path.result.alpha = 1;
    path.result.depth = path.hit.t;
    path.result.shading_normal = vertex.point.shading_normal;
    path.result.geometric_normal = vertex.point.geometric_normal;
    path.result.position = vertex.point.position;
    path.result.albedo = vertex.material.base_color;
    path.result.uv = vertex.point.uv;
    path.result.id = path.hit.instance + 1;
}

void TileTracer::add_emission(Path& path, const Vertex& vertex) const {
    const Vec3f& emission = vertex.material.emission;
    if (emission == Vec3f{}) return;
    const float light_pdf = path.depth > 0 ? lights_.emitter_pdf(path.previous, vertex.point) : 0.0f;
    const float weight = path.depth > 0 ? scalar::power_heuristic(path.bsdf_pdf, light_pdf) : 1.0f;
    path.result.radiance += path.throughput * emission * weight;
}

/// Next-event estimation. The last vertex has no bounce ray that could find the light as well: full weight
/// there.
void TileTracer::sample_light(uint32_t index, const Vertex& vertex, const VertexRandom& random) {
    Path& path = paths_[index];
    const SurfacePoint& point = vertex.point;
    const auto light = lights_.draw({point.position, point.geometric_normal, path.hit.bias},
                                    {random.u_light, random.u_emitter, random.light});
    if (!light) return;
    const Vec3f wi = scalar::to_local(vertex.basis, light->direction);
    const scalar::BsdfValue bsdf = scalar::evaluate_bsdf(vertex.bsdf, vertex.wo_local, wi);
    const bool is_last = path.depth == settings_.bounces;
    const float weight = is_last ? 1.0f : scalar::power_heuristic(light->pdf, bsdf.pdf);
    const Vec3f contribution = path.throughput * bsdf.value * light->weight * weight;
    if (contribution == Vec3f{} || !is_finite(contribution)) return;
    TraceRay ray{tracer_.offset_origin(point, light->direction), 0, light->direction, light->distance,
                 path.hit.bias};
    if (light->emitter) {
        const Vec3f to = tracer_.offset_origin(*light->emitter, -light->direction) - ray.origin;
        ray.t_max = length(to) * (1 - 1e-6f);
        ray.direction = normalize(to);
    }
    shadow_rays_.push_back(ray);
    shadows_.push_back({index, contribution});
    path.result.cost += 1;
}

bool TileTracer::continue_path(Path& path, const Vertex& vertex, const VertexRandom& random) {
    const scalar::BsdfSample drawn =
        scalar::sample_bsdf(vertex.bsdf, vertex.wo_local, random.u_lobe, random.bsdf);
    const Vec3f direction = normalize(scalar::from_local(vertex.basis, drawn.direction));
    if (drawn.weight == Vec3f{} || dot(vertex.point.geometric_normal, direction) <= 0) return false;
    path.throughput = path.throughput * drawn.weight;
    if (!is_finite(path.throughput) || !survives_roulette(path, random.u_roulette)) return false;
    path.previous = vertex.point.position;
    path.bsdf_pdf = drawn.pdf;
    start_bounce_ray(path, vertex, direction,
                     scalar::is_wide_bounce(drawn.is_specular, vertex.material.roughness));
    path.result.cost += 1;
    ++path.depth;
    return true;
}

bool TileTracer::survives_roulette(Path& path, float u_roulette) {
    const float probability = scalar::survival_probability(uint32_t(path.depth), path.throughput);
    if (u_roulette >= probability) return false;
    path.throughput *= 1 / probability;
    return true;
}

void TileTracer::start_bounce_ray(Path& path, const Vertex& vertex, const Vec3f& direction, bool is_wide) {
    const uint32_t bias = path.hit.bias;
    if (is_wide && settings_.level == kAutoLevel && bias < scalar::kLargestBias)
        bounces_.push_back({uint32_t(&path - paths_.data()), vertex.is_flipped});
    path.ray = {tracer_.offset_origin(vertex.point, direction), 0, direction, kInfinity, bias};
}

/// A wide bounce sees a coarser surface and must start on it, unless the direction would lead inside there.
void TileTracer::coarsen_bounces() {
    hits_.clear();
    for (const BounceRay& bounce : bounces_) {
        const TraceHit& hit = paths_[bounce.path].hit;
        hits_.push_back(tracer_.locate_on(hit, hit.bias + 1u));
    }
    points_.resize(hits_.size());
    tracer_.evaluate_points(hits_, points_, scratch_);
    for (size_t k = 0; k < bounces_.size(); ++k) {
        TraceRay& ray = paths_[bounces_[k].path].ray;
        const float side =
            dot(points_[k].geometric_normal, ray.direction) * (bounces_[k].is_flipped ? -1.0f : 1.0f);
        if (side > 0) ray.origin = tracer_.offset_origin(points_[k], ray.direction), ++ray.bias;
    }
    bounces_.clear();
}

/// Points of the hits of all paths that are still on their way.
void TileTracer::make_points() {
    hits_.clear();
    for (const uint32_t i : active_) hits_.push_back(paths_[i].hit);
    points_.resize(hits_.size());
    tracer_.make_surface_points(hits_, points_, scratch_);
}

void TileTracer::trace_shadow_rays(int depth) {
    occluded_.assign(shadow_rays_.size(), 0);
    tracer_.any_hits(shadow_rays_, occluded_, depth);
    for (size_t k = 0; k < shadows_.size(); ++k)
        if (!occluded_[k]) paths_[shadows_[k].path].result.radiance += shadows_[k].contribution;
    counters_.shadow_rays += shadow_rays_.size();
}

void TileTracer::finish_paths() {
    const Timer timer;
    for (const Path& path : paths_) film_.add_sample(path.x, path.y, path.result);
    counters_.film_s += timer.seconds();
}

VertexRandom TileTracer::draw_random(const Path& path) const {
    const auto draw_pair = [&](uint32_t kind) {
        return scalar::draw_bounce_pair(path.seed, sample_index_, uint32_t(path.depth), kind);
    };
    const Vec2f pick = draw_pair(scalar::kPickPair);
    VertexRandom random{pick.x, pick.y, draw_pair(scalar::kLightPair), draw_pair(scalar::kBsdfPair)};
    if (uint32_t(path.depth) >= scalar::kRouletteDepth || lights_.has_emitters()) {
        const Vec2f pair = draw_pair(scalar::kRoulettePair);
        random.u_roulette = pair.x, random.u_emitter = pair.y;
    }
    return random;
}

} // namespace

void trace_tile(const PathTracerScene& scene, Film& film, const Window& tile, SampleRange samples,
                TileCounters& counters) {
    TileTracer tracer(scene, film, tile, counters);
    for (int k = samples.first; k < samples.first + samples.count; ++k) tracer.trace_sample(k);
}

} // namespace relief::cpu
