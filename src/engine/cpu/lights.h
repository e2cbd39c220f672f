// All that gives light, for next-event estimation and for the rays that find a light by themselves.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "engine/cpu/environment_light.h"
#include "engine/cpu/tracer.h"
#include "math/scalar.h"

namespace relief::cpu {

/// A direction towards a light. Densities are per solid angle and hold the probability of having picked the
/// light.
struct LightSample {
    Vec3f direction{};  ///< unit length
    float distance = 0; ///< infinity for the environment and suns
    Vec3f weight{};     ///< radiance / pdf; irradiance / probability for a delta light
    float pdf = 0;      ///< infinity for a delta light
    std::optional<SurfacePoint>
        emitter; ///< set when the light is a surface that the shadow ray must stop short of
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
    bool has_emitters() const { return emitter_cumulative_.size() > 1; }

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
    enum class Kind { environment, sun, point, emitters };
    struct Source {
        Kind kind;
        uint32_t light;        ///< index into PreparedScene::lights for suns and point lights
        float power;           ///< luminance of what irradiance_estimate scales
        scalar::Basis basis{}; ///< suns: about the direction towards it
        float cone = 0;        ///< suns: 1 - cos of the half angle
    };
    /// Patches of one emissive instance within the table of emitters.
    struct EmitterRange {
        uint32_t instance;
        uint32_t first;
    };

    void add_emitters();
    void add_lights();
    float estimate_irradiance(const Source& source, const Vec3f& position) const;
    float total_irradiance(const Vec3f& position) const;
    LightSample draw_sun(const Source& source, const Vec2f& u) const;
    LightSample draw_point(const Source& source, const Vec3f& position, const Vec2f& u) const;
    LightSample draw_emitter(const Vec3f& position, uint32_t bias, float u_emitter, const Vec2f& u) const;
    float emitter_density(uint32_t emitter, const Vec3f& origin, const SurfacePoint& point) const;

    const Tracer& tracer_;
    std::optional<EnvironmentLight> environment_;
    std::vector<Source> sources_;
    std::vector<double> emitter_cumulative_;   ///< 0 ... 1 over all emissive patches
    std::vector<EmitterRange> emitter_ranges_; ///< rising in `first`
    std::vector<uint32_t> first_of_instance_;  ///< kNoIndex: not emissive
    Vec3f emitter_center_{};
    float emitter_radius2_ = 0;
};

} // namespace relief::cpu
