// Lattice noise that the sample maps are made of: fixed by its seed, the same on every machine and thread.
#pragma once

#include <cstdint>

#include "math/vec.h"

namespace relief::samples {

/// Well-mixed 32 bits of a lattice point and a seed.
uint32_t hash(int32_t x, int32_t y, int32_t z, uint32_t seed);

/// A fraction in [0, 1) from hashed bits.
inline float to_unit(uint32_t bits) { return float(bits >> 8) * 0x1p-24f; }

/// The index within [0, period).
inline int32_t wrap(int32_t index, int32_t period) {
    const int32_t rest = index % period;
    return rest < 0 ? rest + period : rest;
}

/// Gradient noise over space (Perlin 2002, Improving Noise), about [-1, 1].
float noise(const Vec3f& p, uint32_t seed);

/// Gradient noise over the plane that repeats after `period_x`, `period_y` lattice cells (both >= 1).
float tile_noise(const Vec2f& p, int period_x, int period_y, uint32_t seed);

/// Octaves of noise(), each twice as fine and half as strong; about [-1, 1].
float fractal_noise(const Vec3f& p, int octaves, uint32_t seed);

/// Octaves of tile_noise(), the first with the given periods.
float fractal_tile_noise(const Vec2f& p, int period_x, int period_y, int octaves, uint32_t seed);

/// Sharp crests at the zeros of the noise, about [0, 1] (Musgrave's ridged form).
float ridged_noise(const Vec3f& p, int octaves, uint32_t seed);
float ridged_tile_noise(const Vec2f& p, int period_x, int period_y, int octaves, uint32_t seed);

/// 0 below `low`, 1 above `high`, smooth between.
inline float smooth_step(float low, float high, float x) {
    const float f = std::fmin(std::fmax((x - low) / (high - low), 0.0f), 1.0f);
    return f * f * (3 - 2 * f);
}

inline float lerp(float a, float b, float f) { return a + (b - a) * f; }
inline Vec3f lerp(const Vec3f& a, const Vec3f& b, float f) { return a + (b - a) * f; }

/// A small generator for placing things (PCG, O'Neill 2014): the same sequence for the same seed everywhere.
class Random {
  public:
    explicit Random(uint32_t seed) : state_(uint64_t(seed) * 0x9e3779b97f4a7c15u + 0x853c49e6748fea9bu) {
        next();
    }
    /// [0, 1)
    float unit() { return to_unit(next()); }
    float range(float low, float high) { return low + (high - low) * unit(); }

  private:
    uint32_t next() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        const uint32_t shifted = uint32_t(((state_ >> 18) ^ state_) >> 27), turn = uint32_t(state_ >> 59);
        return (shifted >> turn) | (shifted << ((32 - turn) & 31));
    }
    uint64_t state_;
};

} // namespace relief::samples
