// The environment as a light: radiance by direction, and directions drawn by brightness.
#pragma once

#include <span>
#include <vector>

#include "formulas/environment_data.h"
#include "prepare/environment_distribution.h"
#include "relief/scene.h"

namespace relief::cpu {

struct ShadingKernels;

/// A direction towards the environment.
struct DirectionSample {
    Vec3f direction;
    float pdf;        ///< per solid angle; 0: nothing could be drawn
    Vec2f position{}; ///< in the image
};

/// Radiance from a direction and the density with which it is drawn.
struct EnvironmentLookup {
    Vec3f radiance;
    float pdf;
};

/// Where the SIMD kernels find an environment with an image; valid as long as the light.
struct EnvironmentTables {
    const Texture* texture;
    scalar::EnvironmentData data;
    const float* rows;    ///< of the EnvironmentDistribution
    const float* columns; ///< likewise
    /// Where to search for a random number in [k, k + 1) / kGuides: kGuides entries a row of cells, then as
    /// many for the rows. Each has the first interval that may be meant and, in the upper half, the last.
    const uint32_t* guides;

    static constexpr uint32_t kGuides = 64; ///< a power of two, so that k / kGuides is exact
};

/// Immutable once made.
class EnvironmentLight {
  public:
    explicit EnvironmentLight(const Environment& environment);

    const Environment& environment() const { return environment_; }

    Vec3f radiance(const Vec3f& direction) const { return look_up(direction).radiance; }
    /// At a place of the image.
    Vec3f radiance(const Vec2f& position) const;
    float pdf(const Vec3f& direction) const { return look_up(direction).pdf; }
    /// Both at once.
    EnvironmentLookup look_up(const Vec3f& direction) const;
    /// Draws by brightness (formulas/environment.h); uniformly over the sphere without an image.
    DirectionSample draw_direction(const Vec2f& u) const;

    // The same of many, by SIMD kernels; the k-th result belongs to the k-th direction, place or pair.
    void look_up(const ShadingKernels& kernels, std::span<const Vec3f> directions,
                 std::span<EnvironmentLookup> found) const;
    void fetch_radiance(const ShadingKernels& kernels, std::span<const Vec2f> positions,
                        std::span<Vec3f> radiances) const;
    void draw_directions(const ShadingKernels& kernels, std::span<const Vec2f> u,
                         std::span<DirectionSample> drawn) const;

    /// Mean over all directions.
    float mean_luminance() const { return distribution_.mean_luminance; }
    size_t byte_count() const;

  private:
    EnvironmentTables tables() const;
    float cell_density(uint32_t column, uint32_t row, const Vec3f& direction) const;

    Environment environment_;
    EnvironmentDistribution distribution_;
    scalar::EnvironmentData data_;
    std::vector<uint32_t> guides_; ///< as EnvironmentTables has them
};

} // namespace relief::cpu
