// The environment as a light: radiance by direction, and directions drawn by brightness.
#pragma once

#include <span>
#include <vector>

#include "engine/environment_distribution.h"
#include "relief/scene.h"

namespace relief::cpu {

/// Immutable once made.
class EnvironmentLight {
  public:
    explicit EnvironmentLight(const Environment& environment);

    Vec3f radiance(const Vec3f& direction) const { return radiance(locate(direction)); }
    /// At a place of the image.
    Vec3f radiance(const Vec2f& position) const;

    struct DirectionSample {
        Vec3f direction;
        float pdf;        ///< per solid angle; 0: nothing could be drawn
        Vec2f position{}; ///< in the image
    };
    /// Draws by brightness (shared/environment.h); uniformly over the sphere without an image.
    DirectionSample draw_direction(const Vec2f& u) const;
    /// The same of many, whose reads of the tables overlap; drawn[k] belongs to u[k].
    void draw_directions(std::span<const Vec2f> u, std::span<DirectionSample> drawn) const;
    Vec3f radiance(const DirectionSample& drawn) const { return radiance(drawn.position); }

    /// Place of the image that is seen along a direction; anywhere without an image.
    Vec2f locate(const Vec3f& direction) const;
    /// Has the texels loaded that radiance() and look_up() will read at a place of the image: a wait for
    /// memory each, unless many are asked for beforehand.
    void prefetch_radiance(const Vec2f& position) const;

    float pdf(const Vec3f& direction) const { return look_up(direction).pdf; }

    /// Radiance from a direction and the density with which it is drawn, both at once.
    struct Lookup {
        Vec3f radiance;
        float pdf;
    };
    Lookup look_up(const Vec3f& direction) const { return look_up(direction, locate(direction)); }
    /// `position`: locate(direction).
    Lookup look_up(const Vec3f& direction, const Vec2f& position) const;

    /// Mean over all directions.
    float mean_luminance() const { return distribution_.mean_luminance; }
    size_t byte_count() const;

  private:
    void draw_block(std::span<const Vec2f> u, std::span<DirectionSample> drawn) const;
    float cell_density(uint32_t column, uint32_t row, const Vec3f& direction) const;

    Environment environment_;
    EnvironmentDistribution distribution_;
    scalar::EnvironmentData data_;
    /// Where to search for a random number: the cells of each row, then the rows.
    std::vector<uint16_t> guides_;
};

} // namespace relief::cpu
