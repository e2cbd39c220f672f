// The environment as a light: radiance by direction, and directions drawn by brightness.
#pragma once

#include <vector>

#include "engine/environment_distribution.h"
#include "relief/scene.h"

namespace relief::cpu {

/// Immutable once made.
class EnvironmentLight {
  public:
    explicit EnvironmentLight(const Environment& environment);

    Vec3f radiance(const Vec3f& direction) const;

    struct DirectionSample {
        Vec3f direction;
        float pdf;        ///< per solid angle; 0: nothing could be drawn
        Vec2f position{}; ///< in the image
    };
    /// Draws by brightness (shared/environment.h); uniformly over the sphere without an image.
    DirectionSample draw_direction(const Vec2f& u) const;
    Vec3f radiance(const DirectionSample& drawn) const;
    float pdf(const Vec3f& direction) const { return look_up(direction).pdf; }

    /// Radiance from a direction and the density with which it is drawn, both at once.
    struct Lookup {
        Vec3f radiance;
        float pdf;
    };
    Lookup look_up(const Vec3f& direction) const;

    /// Mean over all directions.
    float mean_luminance() const { return distribution_.mean_luminance; }
    size_t byte_count() const;

  private:
    float cell_density(uint32_t column, uint32_t row, const Vec3f& direction) const;

    Environment environment_;
    EnvironmentDistribution distribution_;
    scalar::EnvironmentData data_;
    /// Where to search for a random number: the cells of each row, then the rows.
    std::vector<uint16_t> guides_;
};

} // namespace relief::cpu
