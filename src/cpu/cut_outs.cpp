#include "cpu/cut_outs.h"

#include <algorithm>
#include <limits>

#include "cpu/shading/textures.h"
#include "prepare/prepared_scene.h"

namespace relief::cpu {

namespace {

float find_opacity(const Material& material, const Vec2f& uv) {
    const float factor = material.opacity_texture
                             ? fetch_texture(*material.opacity_texture, material.opacity_filter, uv).x
                             : 1.0f;
    return std::clamp(material.opacity * factor, 0.0f, 1.0f);
}

/// Of the rays that scratch.indices lists it keeps those that pass what they met.
void keep_passed(const Tracer& tracer, std::span<const TraceHit> hits, uint32_t round, const CutOutDraw& draw,
                 CutOutScratch& scratch) {
    const PreparedScene& scene = tracer.scene();
    const auto get_material = [&](const TraceHit& hit) -> const Material& {
        return scene.materials[scene.instances[hit.instance].material];
    };
    std::erase_if(scratch.indices,
                  [&](uint32_t k) { return !hits[k].is_hit() || !is_cut_out(get_material(hits[k])); });
    scratch.hits.clear();
    for (const uint32_t k : scratch.indices) scratch.hits.push_back(hits[k]);
    scratch.points.resize(scratch.hits.size());
    tracer.make_surface_points(scratch.hits, scratch.points, scratch.patches);
    size_t kept = 0;
    for (size_t n = 0; n < scratch.indices.size(); ++n) {
        const uint32_t k = scratch.indices[n];
        scratch.indices[kept] = k;
        kept += draw(k, round) >= find_opacity(get_material(hits[k]), scratch.points[n].uv) ? 1 : 0;
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
                   std::span<TraceHit> hits, int depth, const CutOutDraw& draw, CutOutScratch& scratch) {
    scratch.indices.resize(rays.size());
    for (uint32_t k = 0; k < rays.size(); ++k) scratch.indices[k] = k;
    for (uint32_t round = 0;; ++round) {
        keep_passed(tracer, hits, round, draw, scratch);
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
