// All that gives light, for next-event estimation and for the rays that find a light by themselves.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cpu/shading/environment_light.h"
#include "cpu/shading/light_choice.h"
#include "cpu/tracer.h"
#include "formulas/constants.h"
#include "formulas/glass.h"
#include "formulas/glass_parameters.h"
#include "formulas/light.h"
#include "formulas/light_source.h"
#include "formulas/light_tree.h"
#include "prepare/light_sources.h"

namespace relief::cpu {

/// A direction towards a light; `pdf` and `weight` hold the probability of having picked the light.
struct LightSample : scalar::LightDraw {
    Vec2f place{}; ///< in the environment's image, where the light is from there
    /// The radiance of `place` is not in `weight` yet: LightSet::complete_weight().
    bool lacks_radiance = false;
    uint32_t group = kNoIndex; ///< as LightSourceData::group
    /// Set when the light is a surface that the shadow ray must stop short of.
    std::optional<SurfacePoint> emitter;
};

/// Lights of the scene's list are seen by bounce rays, by camera rays only where they are to be, and they
/// block nothing.
class LightSet {
  public:
    /// The tracer must outlive the set.
    explicit LightSet(const Tracer& tracer);

    /// Surfaces that glow may have changed their shape. Not while lights are drawn.
    void follow_surfaces();

    /// Anything may have changed. Not while lights are drawn.
    void follow_scene();

    /// What is lit.
    struct Receiver {
        Vec3f position;
        uint32_t lod_bias; ///< emitters are sampled on surface M_bias
        Vec3f normal;      ///< geometric, on the viewer's side
        uint32_t instance;
    };

    /// Draws one light by its estimated irradiance, then a direction towards it: `u_light` picks the light,
    /// `u_emitter` the emissive patch (or goes on with picking one of many lights), `u` the point. Its pdf is
    /// 0 where nothing could be drawn: all is dark, or a light is at the point itself or seen edge on. It may
    /// lie behind the surface.
    struct RandomNumbers {
        float u_light, u_emitter;
        Vec2f u;
    };
    /// For many points; drawn[k] belongs to at[k].
    void draw(std::span<const Receiver> at, std::span<const RandomNumbers> random,
              std::span<LightSample> drawn) const;
    /// Completes the weights of drawn[which[...]] from the environment, which lack its radiance: the image,
    /// too large for a cache, is not read for the many directions that lead into the surface.
    void complete_weight(std::span<LightSample> drawn, std::span<const uint32_t> which) const;

    bool has_emitters() const { return emitters_.size() > 0; }
    /// False: `u_emitter` is never looked at.
    bool needs_emitter_number() const { return has_emitters() || choice_.has_tree(); }

    /// The environment along many directions; black without one.
    void look_up_environment(std::span<const Vec3f> directions, std::span<EnvironmentLookup> found) const;

    /// Whether rays that hit a surface may have met a light on their way.
    bool has_analytic_lights() const { return has_analytic_lights_; }

    /// A bounce ray, and how far it came.
    struct BounceRay {
        scalar::LitPoint from;
        Vec3f direction;
        float distance;                                ///< infinity: out of the scene
        float bsdf_pdf;                                ///< the ray's own density
        const scalar::GlassParameters* body = nullptr; ///< that it goes through, which takes its part
    };
    /// Light of the environment and of the scene's lights that a bounce ray meets, weighted against the
    /// density of drawing it. `behind`: the environment along the ray, where the distance is infinite.
    Vec3f evaluate_mis(const BounceRay& ray, const EnvironmentLookup& behind) const;

    /// Calls visit(source, light) for each light that evaluate_mis() adds up.
    template <class Visit>
    void meet_each(const BounceRay& ray, const EnvironmentLookup& behind, const Visit& visit) const;

    /// False: see() is nothing for all rays.
    bool has_visible_lights() const { return has_visible_lights_; }
    /// The lights themselves that a camera ray meets within `distance`.
    struct Sight {
        Vec3f radiance{};
        bool is_met = false; ///< though its texture may be black there
    };
    Sight see(const Vec3f& origin, const Vec3f& direction, float distance) const;
    /// Calls visit(source, light) for each of them that it meets.
    template <class Visit>
    void see_each(const Vec3f& origin, const Vec3f& direction, float distance, const Visit& visit) const;

    /// Density with which draw() would have found a point of an emissive surface.
    float emitter_pdf(const scalar::LitPoint& at, const SurfacePoint& point) const;

    /// Adds the bytes of the tables and the tree of lights to structures_bytes, and those of the distribution
    /// of the environment to displacement_bytes.
    void add_statistics(Statistics& statistics) const;

  private:
    void find_sources();
    void draw_listed(const scalar::LightSourceData& source, const Receiver& at, const Vec2f& u,
                     LightSample& drawn) const;
    void draw_from(const LightChoice::Pick& pick, const Receiver& at, const RandomNumbers& random,
                   LightSample& drawn) const;
    void draw_block(std::span<const Receiver> at, std::span<const RandomNumbers> random,
                    std::span<LightSample> drawn) const;
    struct SharedDraws;
    void draw_from_environment(const SharedDraws& shared, std::span<LightSample> drawn) const;
    void draw_from_suns(const SharedDraws& shared, std::span<LightSample> drawn) const;
    uint32_t find_emitter(float u_emitter) const;
    void draw_emitter(const Receiver& at, uint32_t emitter, const Vec2f& u, LightSample& drawn) const;
    float emitter_density(uint32_t emitter, const Vec3f& origin, const SurfacePoint& point) const;

    const Tracer& tracer_;
    std::optional<EnvironmentLight> environment_;
    EmitterTable emitters_;
    LightChoice choice_;
    bool has_analytic_lights_ = false, has_visible_lights_ = false;
};

template <class Visit>
void LightSet::meet_each(const BounceRay& ray, const EnvironmentLookup& behind, const Visit& visit) const {
    const LightChoice::Shares shares = choice_.find_shares(ray.from);
    const auto meet = [&](const scalar::LightSourceData& source) {
        scalar::LightSeen seen = scalar::meet_light(source, ray.from.position, ray.direction, ray.distance);
        if (source.texture != kNoIndex && seen.pdf > 0)
            seen.radiance = seen.radiance * choice_.fetch_color(source, ray.from.position, ray.direction);
        return seen;
    };
    const auto add = [&](const scalar::LightSourceData& source, const scalar::LightSeen& seen, float share) {
        const Vec3f light = seen.radiance * scalar::power_heuristic(ray.bsdf_pdf, seen.pdf * share);
        visit(source, ray.body ? light * scalar::absorb_along(ray.body->depth, seen.distance) : light);
    };
    for (const scalar::LightSourceData& source : choice_.listed()) {
        if (!choice_.is_lit(source, ray.from)) continue;
        scalar::LightSeen seen = meet(source);
        if (source.kind == scalar::kSourceEnvironment && ray.distance == scalar::make_infinity())
            seen = {behind.radiance, behind.pdf, ray.distance};
        if (!(seen.radiance == Vec3f{}))
            add(source, seen, choice_.find_probability(shares, source, ray.from));
    }
    const auto add_of_tree = [&](const scalar::LightSourceData& source, const auto& find_share) {
        const scalar::LightSeen seen = meet(source);
        if (!(seen.radiance == Vec3f{})) add(source, seen, find_share());
    };
    choice_.visit_met(ray.from, shares, ray.direction, ray.distance, add_of_tree);
}

template <class Visit>
void LightSet::see_each(const Vec3f& origin, const Vec3f& direction, float distance,
                        const Visit& visit) const {
    choice_.visit_seen(origin, direction, distance, [&](const scalar::LightSourceData& source) {
        const Vec3f seen = scalar::see_light(source, origin, direction, distance);
        if (seen == Vec3f{}) return;
        visit(source,
              source.texture == kNoIndex ? seen : seen * choice_.fetch_color(source, origin, direction));
    });
}

} // namespace relief::cpu
