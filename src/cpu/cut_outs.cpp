#include "cpu/cut_outs.h"

#include <cmath>
#include <limits>

#include "cpu/shading/input_look_up.h"
#include "formulas/glass_vertex.h"
#include "prepare/prepared_scene.h"

namespace relief::cpu {

namespace {

/// The rays that are asked about, and what they met.
struct Crossing {
    const Tracer& tracer;
    std::span<const TraceRay> rays;
    std::span<const TraceHit> hits;
    uint32_t round;
    const CutOutPaths& paths;
};

uint32_t find_material(const PreparedScene& scene, const TraceHit& hit) {
    return scene.instances[hit.instance].material;
}

/// Null: of a surface that is no clear wall.
const scalar::GlassParameters* find_clear_wall(const PreparedScene& scene, uint32_t material) {
    const scalar::GlassParameters* glass = scene.glass.find(material);
    return glass && glass->kind == scalar::kClearWall ? glass : nullptr;
}

bool may_pass(const PreparedScene& scene, const TraceHit& hit) {
    if (!hit.is_hit()) return false;
    const uint32_t material = find_material(scene, hit);
    return is_cut_out(scene.materials[material]) || find_clear_wall(scene, material);
}

bool passes(const Crossing& crossing, uint32_t k, const SurfacePoint& point) {
    const PreparedScene& scene = crossing.tracer.scene();
    const CutOutPaths& paths = crossing.paths;
    const uint32_t index = find_material(scene, crossing.hits[k]);
    const WallNumbers wall = find_wall_numbers(scene, index, place_hit(scene, crossing.hits[k], point.uv));
    if (!find_clear_wall(scene, index)) return paths.draw(k, crossing.round) >= wall.opacity;
    const float cosine = std::fabs(dot(point.geometric_normal, crossing.rays[k].direction));
    const Vec3f left = scalar::pass_clear_wall(wall.glass, wall.metallic, wall.opacity, cosine);
    const float share = scalar::largest_component(left);
    const bool is_by_weight = paths.rule == WallRule::by_weight;
    if (is_by_weight ? !(share > 0) : paths.draw(k, crossing.round) < 1 - share) return false;
    paths.pass_wall(k, is_by_weight ? left : left * (1 / share));
    return true;
}

/// Of the rays that scratch.indices lists it keeps those that pass what they met.
void keep_passed(const Crossing& crossing, CutOutScratch& scratch) {
    const PreparedScene& scene = crossing.tracer.scene();
    std::erase_if(scratch.indices, [&](uint32_t k) { return !may_pass(scene, crossing.hits[k]); });
    scratch.hits.clear();
    for (const uint32_t k : scratch.indices) scratch.hits.push_back(crossing.hits[k]);
    scratch.points.resize(scratch.hits.size());
    crossing.tracer.make_surface_points(scratch.hits, scratch.points, scratch.patches);
    size_t kept = 0;
    for (size_t n = 0; n < scratch.indices.size(); ++n) {
        const uint32_t k = scratch.indices[n];
        scratch.indices[kept] = k;
        kept += passes(crossing, k, scratch.points[n]) ? 1 : 0;
    }
    scratch.indices.resize(kept);
}

/// From behind the hits on.
void gather_rays(std::span<const TraceRay> rays, std::span<const float> coarse_from,
                 std::span<const TraceHit> hits, CutOutScratch& scratch) {
    scratch.rays.clear(), scratch.coarse_from.clear();
    for (const uint32_t k : scratch.indices) {
        TraceRay ray = rays[k];
        ray.t_min = hits[k].t;
        scratch.rays.push_back(ray);
        if (coarse_from.empty()) continue;
        // Whoever is beyond sees one surface from there on, at the LOD bias that came back.
        scratch.coarse_from.push_back(hits[k].t < coarse_from[k] ? coarse_from[k]
                                                                 : std::numeric_limits<float>::infinity());
    }
    scratch.hits.resize(scratch.rays.size());
}

} // namespace

void pass_cut_outs(const Tracer& tracer, std::span<TraceRay> rays, std::span<const float> coarse_from,
                   std::span<TraceHit> hits, int depth, const CutOutPaths& paths, CutOutScratch& scratch) {
    scratch.indices.resize(rays.size());
    for (uint32_t k = 0; k < rays.size(); ++k) scratch.indices[k] = k;
    for (uint32_t round = 0;; ++round) {
        keep_passed({tracer, rays, hits, round, paths}, scratch);
        if (scratch.indices.empty()) return;
        gather_rays(rays, coarse_from, hits, scratch);
        if (coarse_from.empty())
            tracer.continued_hits(scratch.rays, scratch.hits, depth);
        else
            closest_bounce_hits(tracer, scratch.rays, scratch.coarse_from, scratch.hits, depth,
                                scratch.bounces, scratch.patches);
        for (size_t n = 0; n < scratch.indices.size(); ++n)
            rays[scratch.indices[n]] = scratch.rays[n], hits[scratch.indices[n]] = scratch.hits[n];
    }
}

} // namespace relief::cpu
