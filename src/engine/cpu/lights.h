// All that gives light, for next-event estimation and for the rays that find a light by themselves.
#pragma once

#include <memory>
#include <optional>
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

/// Suns and point lights are seen by bounce rays but not by camera rays, and they block nothing. Immutable
/// once made.
class LightSet {
  public:
    /// The tracer must outlive the set.
    explicit LightSet(const Tracer& tracer);

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

    /// False: `u_emitter` is never looked at.
    bool has_emitters() const { return emitters_.size() > 0; }

    /// Radiance of the environment along a direction; black without one.
    Vec3f environment_radiance(const Vec3f& direction) const;

    /// Light of the environment (when `distance` is infinite), suns and point lights that a bounce ray meets
    /// within `distance`, each weighted against its chance of being drawn from `origin`; `bsdf_pdf` is the
    /// ray's own density.
    Vec3f gather(const Vec3f& origin, const Vec3f& direction, float distance, float bsdf_pdf) const;

    /// Density with which draw() from `origin` would have found a point of an emissive surface.
    float emitter_pdf(const Vec3f& origin, const SurfacePoint& point) const;

    size_t byte_count() const;

  private:
    float total_irradiance(const Vec3f& position) const;
    std::optional<LightSample> draw_environment(const Receiver& at, const Vec2f& u) const;
    LightSample draw_emitter(const Receiver& at, float u_emitter, const Vec2f& u) const;
    float emitter_density(uint32_t emitter, const Vec3f& origin, const SurfacePoint& point) const;

    const Tracer& tracer_;
    std::optional<EnvironmentLight> environment_;
    EmitterTable emitters_;
    std::vector<scalar::LightSourceData> sources_;
};

} // namespace relief::cpu
