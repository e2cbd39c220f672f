#include "cpu/path_lights.h"

#include "formulas/path.h"

namespace relief::cpu {

static_assert(kLightKinds.size() == scalar::kKindCount);

void PathLights::start(size_t path_count) {
    sums_.assign(path_count * count_, Vec3f{});
    if (has_kinds_) shares_.resize(path_count);
    if (has_guides_) is_guided_.assign(path_count, 0);
}

void PathLights::add_seen(uint32_t path, uint32_t kind, uint32_t group, const Vec3f& light) {
    if (has_kinds_) sums_[path * count_ + kind] += light;
    add_to_group(path, group, light);
}

void PathLights::add_seen_lights(uint32_t path, const LightSet& lights, const TraceRay& ray, float distance,
                                 const Vec3f& share) {
    lights.see_each(ray.origin, ray.direction, distance,
                    [&](const scalar::LightSourceData& source, const Vec3f& light) {
                        add_seen(path, scalar::kKindEmission, source.group, share * light);
                    });
}

void PathLights::add_background(uint32_t path, bool is_plain, const Vec3f& light) {
    add_seen(path, scalar::kKindBackground, is_plain ? groups_.of_default : groups_.of_environment, light);
}

void PathLights::add_emission(uint32_t path, uint32_t material, const Vec3f& light, int depth) {
    const uint32_t group = groups_.of_material.empty() ? kNoIndex : groups_.of_material[material];
    if (depth == 0)
        add_seen(path, scalar::kKindEmission, group, light);
    else
        add_to_group(path, group, light);
}

void PathLights::add_split(uint32_t path, const Vec3f& light, const scalar::LightShares& shares,
                           uint32_t bounces) {
    const Vec3f diffuse = light * shares.diffuse;
    sums_[path * count_ + scalar::find_light_kind(scalar::kLobeDiffuse, bounces)] += diffuse;
    sums_[path * count_ + scalar::find_light_kind(shares.rest, bounces)] += light - diffuse;
}

void PathLights::add_met_lights(uint32_t path, const Meeting& meeting, int depth) {
    const float scale = scalar::find_clamp_scale(meeting.light, clamp_indirect_, uint32_t(depth - 1));
    const Vec3f factor = meeting.throughput * scale;
    meeting.lights.meet_each(meeting.ray, meeting.behind,
                             [&](const scalar::LightSourceData& source, const Vec3f& light) {
                                 add_to_group(path, source.group, factor * light);
                             });
}

void PathLights::add_shadow_light(size_t index, uint32_t path, const Vec3f& light, uint32_t bounces) {
    const ShadowRay& ray = shadow_rays_[index];
    if (has_kinds_) add_split(path, light, bounces == 0 ? ray.shares : shares_[path], bounces);
    add_to_group(path, ray.group, light);
}

} // namespace relief::cpu
