// Waves of deep water over a square that repeats, from a spectrum (Tessendorf 2001, Simulating Ocean Water).
#pragma once

#include <complex>
#include <cstdint>
#include <memory>
#include <vector>

#include "relief/image.h"
#include "relief/types.h"

namespace relief::samples {

class Ocean {
  public:
    struct Config {
        uint32_t size = 256;     ///< texels a side, a power of 2
        double tile = 32;        ///< length of a side, metres
        double wind_speed = 4.5; ///< m/s, along +x turned by `wind_degrees` towards +z
        double wind_degrees = 35;
        double height = 0.7;     ///< significant: four standard deviations, metres
        double shortest = 0.5;   ///< waves much shorter than this are left out, metres
        double choppiness = 0.9; ///< of the movement along the water: 0 none, 1 that of real waves
        uint32_t seed = 11;
    };
    explicit Ocean(const Config& config);

    /// Displacement (x, height, z) of the water at each texel, in metres, as halves; columns along +x, rows
    /// along +z.
    std::shared_ptr<const Texture> make_map(double seconds) const;

    /// That of a map at a place, bilinear; x, z in metres from the tile's corner.
    Vec3f displace(const Texture& map, double x, double z) const;

    /// Least area that a texel's square of water keeps, seen from above, of its own; below 0 it folds over.
    double measure_least_area(const Texture& map) const;

  private:
    using Complex = std::complex<double>;

    struct Wave {
        Complex there, back;  ///< amplitudes of the wave along its vector, and against it
        double x = 0, z = 0;  ///< direction, a unit vector
        double frequency = 0; ///< radians a second
    };
    Wave make_wave(uint32_t column, uint32_t row, const std::vector<Complex>& amplitudes) const;
    double compute_power(double kx, double kz) const;
    double get_wave_number(uint32_t index) const;

    Config config_;
    std::vector<Wave> waves_; ///< by row and column of the transform
};

} // namespace relief::samples
