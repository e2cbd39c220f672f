// All that gives light, for next-event estimation and for the rays that find a light by themselves.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/cpu/environment_light.h"
#include "engine/cpu/tracer.h"
#include "engine/light_sources.h"
#include "math/scalar.h"

namespace relief::cpu {

/// A direction towards a light; `pdf` and `weight` hold the probability of having picked the light.
struct LightSample : scalar::LightDraw {
    /// Set when the light is a surface that the shadow ray must stop short of.
    std::optional<SurfacePoint> emitter;
};

/// Suns and point lights are seen by bounce rays but not by camera rays, and they block nothing.
class LightSet {
  public:
    /// The tracer must outlive the set.
    explicit LightSet(const Tracer& tracer);

    /// Surfaces that glow may have changed their shape. Not while lights are drawn.
    void follow_surfaces();

    /// What is lit: a point, and the normal of the side that matters.
    struct Receiver {
        Vec3f position, normal;
        uint32_t bias; ///< emitters are sampled on surface M_bias
    };

    /// Draws one light by its estimated irradiance, then a direction towards it: `u_light` picks the light,
    /// `u_emitter` the emissive patch, `u` the point. Nothing when all is dark or the light is behind.
    struct RandomNumbers {
        float u_light, u_emitter;
        Vec2f u;
    };
    std::optional<LightSample> draw(const Receiver& at, const RandomNumbers& random) const;
    /// The same of many points, whose reads of the image overlap; drawn[k] belongs to at[k].
    void draw(std::span<const Receiver> at, std::span<const RandomNumbers> random,
              std::span<std::optional<LightSample>> drawn) const;

    /// False: `u_emitter` is never looked at.
    bool has_emitters() const { return emitters_.size() > 0; }

    /// Where the environment's image is seen along a direction.
    Vec2f locate_environment(const Vec3f& direction) const {
        return environment_ ? environment_->locate(direction) : Vec2f{};
    }
    /// Has what is to be read there loaded: for places that lie apart, all of them before any is read.
    void prefetch_environment(const Vec2f& position) const {
        if (environment_) environment_->prefetch_radiance(position);
    }
    /// Radiance of the environment there; black without one.
    Vec3f environment_radiance(const Vec2f& position) const;

    /// A bounce ray, and how far it came.
    struct BounceRay {
        Vec3f origin, direction;
        float distance; ///< infinity: out of the scene
        float bsdf_pdf; ///< the ray's own density
    };
    /// Light of the environment, suns and point lights that a bounce ray meets, each weighted against its
    /// chance of being drawn from the origin. `position`: locate_environment(direction), where the distance
    /// is infinite.
    Vec3f gather(const BounceRay& ray, const Vec2f& position) const;

    /// Density with which draw() from `origin` would have found a point of an emissive surface.
    float emitter_pdf(const Vec3f& origin, const SurfacePoint& point) const;

    size_t byte_count() const;

  private:
    void find_sources();
    float total_irradiance(const Vec3f& position) const;
    /// One light, and the probability of having picked it.
    struct Pick {
        const scalar::LightSourceData* source; ///< null: all is dark
        float probability;
    };
    Pick pick_source(const Vec3f& position, float u_light) const;
    LightSample draw_from(const Pick& pick, const Receiver& at, const RandomNumbers& random) const;
    void draw_block(std::span<const Receiver> at, std::span<const RandomNumbers> random,
                    std::span<std::optional<LightSample>> drawn) const;
    LightSample draw_emitter(const Receiver& at, float u_emitter, const Vec2f& u) const;
    float emitter_density(uint32_t emitter, const Vec3f& origin, const SurfacePoint& point) const;

    const Tracer& tracer_;
    std::optional<EnvironmentLight> environment_;
    EmitterTable emitters_;
    std::vector<scalar::LightSourceData> sources_;
};

} // namespace relief::cpu
