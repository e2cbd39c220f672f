// The environment as a light: radiance by direction, and directions drawn by brightness.
#pragma once

#include <vector>

#include "relief/scene.h"

namespace relief::cpu {

/// Immutable once made.
class EnvironmentLight {
  public:
    explicit EnvironmentLight(const Environment& environment);

    Vec3f radiance(const Vec3f& direction) const;

    struct DirectionSample {
        Vec3f direction;
        float pdf;         ///< per solid angle; 0: nothing could be drawn
        Vec2f position{};  ///< in the image
    };
    /// Draws from a piecewise constant density over latitude and longitude, luminance times sin(theta);
    /// uniformly over the sphere without an image (Pharr, Jakob and Humphreys 2023, Physically Based
    /// Rendering, section 12.5.2).
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
    float mean_luminance() const { return mean_luminance_; }
    size_t byte_count() const { return (rows_.size() + columns_.size()) * sizeof(float); }

  private:
    void build_distribution();
    float cell_density(uint32_t column, uint32_t row, const Vec3f& direction) const;
    Vec3f local_from_world(const Vec3f& d) const;
    Vec3f world_from_local(const Vec3f& d) const;

    Environment environment_;
    Vec3f scale_{};
    float sin_turn_ = 0, cos_turn_ = 1;
    float mean_luminance_ = 0;
    uint32_t cells_x_ = 0, cells_y_ = 0;
    std::vector<float> rows_;    ///< cells_y_ + 1 cumulative probabilities
    std::vector<float> columns_; ///< cells_x_ + 1 cumulative probabilities a row
};

} // namespace relief::cpu
