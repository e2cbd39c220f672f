// The vertices of a wave: lights that its rays meet, light that falls onto their hits, and the rays that go
// on.
#include <algorithm>

#include "base/timer.h"
#include "cpu/glass_paths.h"
#include "cpu/shading/normal_maps.h"
#include "cpu/shading/terminator.h"
#include "cpu/shading/vertex_access.h"
#include "cpu/tile_tracer.h"
#include "formulas/bounce_lod.h"
#include "formulas/bsdf.h"
#include "formulas/glass.h"
#include "formulas/light.h"

namespace relief::cpu {

namespace {

/// What shadows are caught by: white and diffuse, so that nothing but light and its cosine counts.
constexpr PointMaterial kCatcherMaterial{{1, 1, 1}, {0, 0, 0}, 1, 0, 1, kNoIndex, kNoIndex, kNoIndex};

/// Of light along `direction` to a surface.
bool is_from_behind(const VertexLanes& lanes, size_t lane, const Vec3f& direction) {
    return dot(get_lane(lanes.geometric_normal, lane), direction) < 0;
}

/// What comes from behind a surface is transmitted.
scalar::LightShares make_shares(const Vec3f& diffuse, bool is_behind) {
    return {diffuse, is_behind ? scalar::kLobeTransmission : scalar::kLobeSpecular};
}

} // namespace

void TileTracer::shade_paths() {
    const Timer timer;
    shadow_rays_.clear(), shadows_.clear(), path_lights_.clear_shadow_rays();
    add_backgrounds();
    if (path_lights_.has_guides()) note_sky();
    drop_misses();
    if (depth_ <= settings_.image.bounces)
        shade_vertices();
    else
        add_last_emission();
    counters_.shade_s += timer.seconds();
}

/// What rays have hit is lit and scatters; paths that go on stay active.
void TileTracer::shade_vertices() {
    points_.resize(hits_.size()), coarse_from_.resize(hits_.size());
    tracer_.make_surface_points(hits_, points_, scratch_);
    if (tracer_.scene().has_anisotropy) {
        tangents_.resize(hits_.size());
        find_tangents(tracer_.scene(), hits_, points_, tangents_);
    }
    if (tracer_.scene().has_normal_maps) map_shading_normals(tracer_.scene(), hits_, points_);
    draw_random();
    size_t next = 0;
    for (size_t first = 0; first < active_.size(); first += kBlock)
        next = shade_block(first, std::min(kBlock, active_.size() - first), next);
    active_.resize(next), rays_.resize(next), coarse_from_.resize(next);
    counters_.bounce_rays += active_.size();
}

/// Of the rays that look for light alone.
void TileTracer::add_last_emission() {
    if (lights_.has_emitters()) {
        points_.resize(hits_.size());
        tracer_.make_surface_points(hits_, points_, scratch_);
        if (has_glass_) draw_random();
        for (size_t first = 0; first < active_.size(); first += kBlock) {
            const size_t count = std::min(kBlock, active_.size() - first);
            meet_materials(first, count, BaseColor::factor_alone); // emission does not depend on it
            for (size_t n = 0; n < count; ++n)
                if (!(materials_[n].emission == Vec3f{})) add_emission(first + n, materials_[n].emission);
        }
    }
    active_.clear();
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
    if (depth_ == 0 && lights_.has_visible_lights()) {
        for (size_t k = 0; k < active_.size(); ++k) add_lights_before(k, paths_[active_[k]].throughput, {});
        if (has_catchers_) cover_catchers();
    }
    const auto add = [&](size_t n, const Vec3f& light) { add_background(active_[missed_[n]], light); };
    if (depth_ == 0 && settings_.image.background) {
        // Lights cover the background of the picture, which is none of the scene.
        for (size_t n = 0; n < count; ++n)
            if (first_hits_[active_[missed_[n]]].alpha == 0) add(n, *settings_.image.background);
        return;
    }
    lights_.look_up_environment(directions_, backgrounds_);
    if (depth_ > 0) return gather_lights();
    for (size_t n = 0; n < count; ++n) add(n, backgrounds_[n].radiance);
}

/// What the camera sees behind all surfaces; less of it than there is through clear walls.
void TileTracer::add_background(uint32_t path, const Vec3f& light) {
    const Vec3f seen = paths_[path].throughput * light;
    paths_[path].radiance += seen;
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
        path.radiance += share * seen.radiance;
        if (seen.is_met) first_hits_[index].alpha = 1;
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

/// Whether ray k of the camera has met a shadow catcher.
bool TileTracer::is_catcher(size_t k) const {
    return has_catchers_ && depth_ == 0 && tracer_.scene().instances[hits_[k].instance].is_shadow_catcher;
}

/// A light that the camera sees hides the shadows behind it, as it hides the background.
void TileTracer::cover_catchers() {
    for (size_t k = 0; k < active_.size(); ++k)
        if (hits_[k].is_hit() && is_catcher(k) && first_hits_[active_[k]].alpha > 0) hits_[k] = {};
}

void TileTracer::drop_misses() {
    size_t kept = 0;
    for (size_t k = 0; k < active_.size(); ++k)
        if (hits_[k].is_hit())
            active_[kept] = active_[k], rays_[kept] = rays_[k], hits_[kept] = hits_[k], ++kept;
    active_.resize(kept), rays_.resize(kept), hits_.resize(kept);
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
        if (!(materials_[n].emission == Vec3f{})) add_emission(first + n, materials_[n].emission);
        if (path_lights_.looks_for_guides(active_[first + n]))
            note_guides(first + n, lanes_[n / 16], n % 16, materials_[n].emission);
    }
    for (size_t n = 0; n < lit_count; ++n)
        add_shadow_ray(first + lit[n], lanes_[lit[n] / 16], lit[n] % 16, lights_drawn_[lit[n]]);
    for (size_t n = 0; n < count; ++n)
        if ((lanes_[n / 16].has_bounce >> n % 16 & 1) && !is_catcher(first + n))
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
    const uint32_t record =
        lanes.has_glass >> lane & 1 ? vertex_inputs_.find_glass_record(lanes.glass[lane]) : kNoIndex;
    return find_next_body(tracer_.scene().glass,
                          {paths_[active_[k]].body, record, dot(points_[k].geometric_normal, direction),
                           dot(get_lane(lanes.geometric_normal, lane), direction) < 0});
}

/// Of the light that was drawn for vertex n of a block, k of the wave.
float TileTracer::find_lift(size_t k, size_t n) {
    const PreparedScene& scene = tracer_.scene();
    if (scene.terminators == Terminators::none || !(lights_drawn_[n].pdf > 0)) return 0;
    return find_light_lift(scene, hits_[k], points_[k], {lights_drawn_[n].direction, receivers_[n].normal},
                           scratch_.patches);
}

/// Of the surfaces that rays from `first` on have hit, vertices of a block, with what glass does to their
/// paths.
void TileTracer::meet_materials(size_t first, size_t count, BaseColor base_color) {
    make_point_materials(tracer_.scene(), tracer_.shading_kernels(), {&hits_[first], count},
                         {&points_[first], count}, {materials_.data(), count}, base_color);
    for (size_t n = 0; n < count; ++n)
        if (is_catcher(first + n))
            materials_[n] = kCatcherMaterial;
        else
            meet_material(first + n, n);
}

/// Of ray k, vertex n of a block, whose numbers without inputs that have textures are there.
void TileTracer::meet_material(size_t k, size_t n) {
    PointMaterial& m = materials_[n];
    const SurfacePoint& point = points_[k];
    vertex_inputs_.set(n, hits_[k], point.uv, m);
    if (!has_glass_) return;
    Path& path = paths_[active_[k]];
    const GlassArrival arrival{dot(point.geometric_normal, rays_[k].direction), hits_[k].t,
                               vertex_inputs_.glass()};
    path.throughput = path.throughput * meet_glass(tracer_.scene().glass, arrival, path.body, m,
                                                   random_[scalar::kPickPair][k].y);
}

/// Fills lanes_ for a block whose lights are drawn.
void TileTracer::reflect(size_t first, size_t count) {
    meet_materials(first, count, BaseColor::with_texture);
    for (size_t n = 0; n < count; ++n) {
        const size_t k = first + n;
        const PointMaterial& m = materials_[n];
        VertexLanes& lanes = lanes_[n / 16];
        const size_t lane = n % 16;
        set_material(m, lane, lanes);
        set_lane(lights_drawn_[n].direction, lane, lanes.light_direction);
        lanes.light_pdf[lane] = lights_drawn_[n].pdf;
        if (tracer_.scene().has_anisotropy) set_lane(tangents_[k], lane, lanes.tangent);
        lanes.light_lift[lane] = m.glass == kNoIndex ? find_lift(k, n) : 0.0f;
    }
    for (size_t n = count; n % 16 != 0; ++n) set_plain(n % 16, lanes_[n / 16]);
    const bool has_bounce = depth_ < last_depth();
    for (size_t n = 0; n < count; n += 16) {
        const size_t k = first + n;
        tracer_.shading_kernels().reflect(
            {.count = std::min(size_t(16), count - n),
             .points = &points_[k],
             .rays = &rays_[k],
             .pick_pairs = has_bounce ? &random_[scalar::kPickPair][k] : nullptr,
             .bsdf_pairs = has_bounce ? &random_[scalar::kBsdfPair][k] : nullptr,
             .layers = vertex_inputs_.layers(),
             .glass = vertex_inputs_.glass(),
             .wants_diffuse_shares = depth_ == 0 && path_lights_.has_kinds()},
            lanes_[n / 16]);
    }
}

void TileTracer::record_first_hit(size_t k, const VertexLanes& lanes, size_t lane) {
    FilmSample& result = first_hits_[active_[k]];
    if (is_catcher(k)) {
        result.shadow.x = 1;
        return;
    }
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
    paths_[path].radiance += found;
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

/// Whether something is in the way up to where a shadow ray starts.
bool TileTracer::is_covered(size_t k, float lift) {
    const SurfacePoint& point = points_[k];
    const Vec3f up = dot(point.geometric_normal, rays_[k].direction) > 0 ? -point.geometric_normal
                                                                         : point.geometric_normal;
    const TraceRay ray{tracer_.offset_origin(point, up), 0, up, lift, hits_[k].lod_bias};
    TraceHit hit;
    tracer_.continued_hits({&ray, 1}, {&hit, 1}, depth_);
    if (footprints_) note_ray(active_[k], ray, ray.t_max);
    return hit.is_hit();
}

/// Next-event estimation. Without bounces, and on shadow catchers, no other ray can find the light too: full
/// weight.
void TileTracer::add_shadow_ray(size_t k, const VertexLanes& lanes, size_t lane, const LightSample& light) {
    Path& path = paths_[active_[k]];
    const bool is_alone = last_depth() == 0 || is_catcher(k);
    const float weight = is_alone ? 1.0f : scalar::power_heuristic(light.pdf, lanes.light_bsdf_pdf[lane]);
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
    if (is_catcher(k)) first_hits_[active_[k]].shadow.z += scalar::luminance(contribution);
    path.cost += 1;
    if (lanes.light_lift[lane] > 0 && is_covered(k, lanes.light_lift[lane])) return;
    shadow_rays_.push_back(ray);
    shadows_.push_back(
        {active_[k], scalar::clamp_indirect(contribution, settings_.image.clamp_indirect, uint32_t(depth_))});
    if (path_lights_.is_on()) {
        const bool is_behind = lanes.light_lift[lane] == 0 && is_from_behind(lanes, lane, light.direction);
        path_lights_.add_shadow_ray(
            {make_shares(get_lane(lanes.light_diffuse, lane), is_behind), light.group});
    }
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
    path.cost += 1;
    if (depth_ == 0)
        path_lights_.set_shares(active_[k], make_shares(get_lane(lanes.bounce_diffuse, lane),
                                                        is_from_behind(lanes, lane, direction)));
    active_[next] = active_[k];
    rays_[next] = {get_lane(lanes.bounce_origin, lane), 0, direction, kInfinity, uint32_t(hits_[k].lod_bias)};
    // Within a body, between the two surfaces there would be a way in, or none out.
    const bool is_inside = body || dot(points_[k].geometric_normal, direction) < 0;
    coarse_from_[next] = is_inside ? kInfinity
                                   : scalar::find_coarse_distance(bounce_lod_, rays_[next].origin,
                                                                  rays_[next].lod_bias, path.bsdf_pdf);
    return true;
}

} // namespace relief::cpu
