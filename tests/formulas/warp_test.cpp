#include <vector>

#include <gtest/gtest.h>

#include "formulas/basis.h"
#include "formulas/warp.h"
#include "statistics.h"

namespace relief {
namespace {

constexpr int kSamples = 200000;

/// Chi-square of directions against a density over cells of equal (cos theta, phi) area within [lowest, 1].
template <class Draw, class Density> double chi_square(Draw draw, Density density, double lowest) {
    constexpr int rows = 16, columns = 24, fine = 8;
    std::vector<double> counts(rows * columns), expected(rows * columns);
    Random random(1);
    for (int k = 0; k < kSamples; ++k) {
        const Vec3f d = draw(random.next_pair());
        const int row = std::min(rows - 1, int((d.z - lowest) / (1 - lowest) * rows));
        double phi = std::atan2(d.y, d.x) / (2 * std::numbers::pi);
        phi -= std::floor(phi);
        counts[size_t(row * columns + std::min(columns - 1, int(phi * columns)))] += 1;
    }
    double result = 0;
    for (int cell = 0; cell < rows * columns; ++cell) {
        double integral = 0;
        for (int k = 0; k < fine; ++k) {
            const double z = lowest + (1 - lowest) * (cell / columns + (k + 0.5) / fine) / rows;
            integral += density(float(z)) / fine;
        }
        integral *= (1 - lowest) / rows * 2 * std::numbers::pi / columns * kSamples;
        result += (counts[size_t(cell)] - integral) * (counts[size_t(cell)] - integral) / integral;
    }
    return result;
}

TEST(Warp, draws_cosine_distributed_directions) {
    EXPECT_LT(chi_square(scalar::square_to_cosine_hemisphere, scalar::cosine_hemisphere_pdf, 0),
              chi_square_limit(383));
}

TEST(Warp, draws_the_sphere_uniformly) {
    EXPECT_LT(chi_square(
                  scalar::square_to_sphere, [](float) { return scalar::sphere_pdf(); }, -1),
              chi_square_limit(383));
}

TEST(Warp, draws_cones_uniformly) {
    for (float height : {0.01f, 0.3f, 1.5f})
        EXPECT_LT(chi_square([&](Vec2f u) { return scalar::square_to_cone(u, height); },
                             [&](float) { return scalar::cone_pdf(height); }, 1 - double(height)),
                  chi_square_limit(383))
            << height;
}

TEST(Warp, keeps_the_directions_of_a_hair_thin_cone_distinct) {
    const float height = 1e-9f;
    const Vec3f d = scalar::square_to_cone({0.5f, 0.25f}, height);
    EXPECT_NEAR(d.y, std::sqrt(1e-9), 1e-8);
}

TEST(Warp, maps_the_square_onto_the_disk_uniformly) {
    constexpr int rings = 10, sectors = 16;
    std::vector<double> counts(rings * sectors);
    Random random(2);
    for (int k = 0; k < kSamples; ++k) {
        const Vec2f p = scalar::square_to_disk(random.next_pair());
        const double r2 = double(p.x) * p.x + double(p.y) * p.y;
        ASSERT_LE(r2, 1 + 1e-6);
        double phi = std::atan2(p.y, p.x) / (2 * std::numbers::pi);
        phi -= std::floor(phi);
        counts[size_t(std::min(rings - 1, int(r2 * rings)) * sectors +
                      std::min(sectors - 1, int(phi * sectors)))] += 1;
    }
    const double expected = double(kSamples) / counts.size();
    double chi2 = 0;
    for (double count : counts) chi2 += (count - expected) * (count - expected) / expected;
    EXPECT_LT(chi2, chi_square_limit(int(counts.size()) - 1));
    EXPECT_EQ(scalar::square_to_disk({0.5f, 0.5f}).x, 0);
}

TEST(Warp, fills_the_triangle_below_the_diagonal_uniformly) {
    Random random(3);
    double x = 0, y = 0, xx = 0, yy = 0, xy = 0;
    for (int k = 0; k < kSamples; ++k) {
        const Vec2f p = scalar::square_to_triangle(random.next_pair());
        ASSERT_GE(p.y, 0);
        ASSERT_LE(p.y, p.x + 1e-6f);
        ASSERT_LE(p.x, 1);
        x += p.x, y += p.y, xx += p.x * p.x, yy += p.y * p.y, xy += p.x * p.y;
    }
    EXPECT_NEAR(x / kSamples, 2.0 / 3, 2e-3);
    EXPECT_NEAR(y / kSamples, 1.0 / 3, 2e-3);
    EXPECT_NEAR(xx / kSamples, 1.0 / 2, 3e-3);
    EXPECT_NEAR(yy / kSamples, 1.0 / 6, 3e-3);
    EXPECT_NEAR(xy / kSamples, 1.0 / 4, 3e-3);
}

TEST(Warp, makes_orthonormal_right_handed_frames_for_every_normal) {
    Random random(4);
    for (int k = 0; k < 10000; ++k) {
        Vec3f n = scalar::square_to_sphere(random.next_pair());
        if (k == 0) n = {0, 0, -1};
        if (k == 1) n = {0, 0, 1};
        n = normalize(n);
        const scalar::Basis basis = scalar::make_basis(n);
        ASSERT_NEAR(dot(basis.t, basis.n), 0, 1e-6);
        ASSERT_NEAR(dot(basis.b, basis.n), 0, 1e-6);
        ASSERT_NEAR(length(basis.t), 1, 1e-6);
        ASSERT_NEAR(dot(cross(basis.t, basis.b), basis.n), 1, 1e-6);
        const Vec3f v{0.1f, -0.7f, 0.4f};
        ASSERT_NEAR(length(scalar::from_local(basis, scalar::to_local(basis, v)) - v), 0, 1e-6);
    }
}

} // namespace
} // namespace relief
