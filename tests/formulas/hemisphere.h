// Directions of the hemisphere about +z, and whether those drawn are as their density says.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "math/vec.h"

namespace relief {

inline Vec3f direction(float cosine, float phi) {
    const float sine = std::sqrt(1 - cosine * cosine);
    return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

/// Cells of equal solid angle, and the points of each that a density is taken at, along either side.
struct HemisphereCells {
    int rows = 12, columns = 20, fine = 8;
    int count() const { return rows * columns; }
};

/// Sum of squared differences of counts and densities over the cells, in variances, to be compared with
/// chi_square_limit. draw() gives a direction, get_density(wi) its density per solid angle.
template <class Draw, class GetDensity>
double measure_chi2(const HemisphereCells& cells, Draw draw, GetDensity get_density) {
    constexpr int samples = 200000;
    const auto [rows, columns, fine] = cells;
    std::vector<double> counts(size_t(cells.count()));
    for (int k = 0; k < samples; ++k) {
        const Vec3f d = draw();
        if (d.z <= 0) continue;
        double phi = std::atan2(double(d.y), double(d.x)) / (2 * std::numbers::pi);
        phi -= std::floor(phi);
        counts[size_t(std::min(rows - 1, int(d.z * float(rows))) * columns +
                      std::min(columns - 1, int(phi * columns)))] += 1;
    }
    double chi2 = 0;
    for (int cell = 0; cell < cells.count(); ++cell) {
        double integral = 0;
        for (int k = 0; k < fine * fine; ++k) {
            const float z = float((cell / columns + (k / fine + 0.5) / fine) / rows);
            const double phi = 2 * std::numbers::pi * (cell % columns + (k % fine + 0.5) / fine) / columns;
            integral += double(get_density(direction(z, float(phi))));
        }
        integral *= samples * 2 * std::numbers::pi / (cells.count() * fine * fine);
        const double difference = counts[size_t(cell)] - integral;
        if (integral > 5) chi2 += difference * difference / integral;
    }
    return chi2;
}

} // namespace relief
