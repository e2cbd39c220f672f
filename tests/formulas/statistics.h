// Numeric helpers of the formula tests: random points at a fixed seed, and integrals over directions.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "formulas/scalar.h"

namespace relief {

/// Uniform numbers at a fixed seed.
class Random {
  public:
    explicit Random(uint32_t seed) : generator_(seed) {}
    float next() { return float(generator_() >> 8) * 0x1p-24f; }
    Vec2f next_pair() {
        const float x = next();
        return {x, next()};
    }

  private:
    std::mt19937 generator_;
};

/// Integral of f over the upper hemisphere, midpoint rule in (theta, phi) with rows that crowd towards the
/// pole of narrow lobes when `power` > 1: theta = pi/2 s^power.
inline double integrate_hemisphere(const std::function<double(const Vec3f&)>& f, int rows, int columns,
                                   double power = 1) {
    double sum = 0;
    for (int i = 0; i < rows; ++i) {
        const double s = (i + 0.5) / rows;
        const double theta = 0.5 * std::numbers::pi * std::pow(s, power);
        const double width = 0.5 * std::numbers::pi * power * std::pow(s, power - 1) / rows;
        for (int j = 0; j < columns; ++j) {
            const double phi = 2 * std::numbers::pi * (j + 0.5) / columns;
            const Vec3f d{float(std::sin(theta) * std::cos(phi)), float(std::sin(theta) * std::sin(phi)),
                          float(std::cos(theta))};
            sum += f(d) * std::sin(theta) * width * (2 * std::numbers::pi / columns);
        }
    }
    return sum;
}

/// Upper bound of chi-square with many degrees of freedom: mean + 5 standard deviations.
inline double chi_square_limit(int degrees) { return degrees + 5 * std::sqrt(2.0 * degrees); }

} // namespace relief
