// The error of a pixel, told from the means of batches of its samples.
#include <cmath>
#include <cstdint>
#include <random>
#include <sstream>

#include <gtest/gtest.h>

#include "film/film.h"
#include "math/vec.h"

namespace relief {
namespace {

constexpr int kEdge = 64;
constexpr Window kAll{0, 0, kEdge, kEdge};

Film make_film() { return Film(kEdge, kEdge, {}, {}, ErrorEstimate::on); }

void add(Film& film, int x, int y, float radiance) {
    FilmSample sample;
    sample.radiance = {radiance, radiance, radiance};
    film.add_sample(x, y, sample);
}

/// Samples of the mean 1 and the variance 1/3.
void add_independent(Film& film, int count, std::mt19937& random) {
    std::uniform_real_distribution<float> radiance(0.0f, 2.0f);
    for (int y = 0; y < kEdge; ++y)
        for (int x = 0; x < kEdge; ++x)
            for (int k = 0; k < count; ++k) add(film, x, y, radiance(random));
}

TEST(FilmError, of_independent_samples_is_that_of_their_mean) {
    std::mt19937 random(7);
    Film film = make_film();
    int samples = 0;
    for (const int more : {16, 32, 16, 6, 58, 128, 100}) {
        add_independent(film, more, random);
        samples += more;
        // Over a mean of 1, and 0.01 for what is dark.
        const double expected = std::sqrt(1.0 / 3.0 / samples) / 1.01;
        EXPECT_NEAR(film.estimate_error(kAll) / expected, 1.0, samples < 64 ? 0.04 : 0.02) << samples;
    }
}

TEST(FilmError, sees_from_64_samples_on_that_batches_agree) {
    Film film = make_film();
    const auto add_batch = [&] {
        for (int k = 0; k < 16; ++k) add(film, 0, 0, float(2 * (k % 2)));
    };
    const Window pixel{0, 0, 1, 1};
    for (int batch = 0; batch < 3; ++batch) add_batch();
    EXPECT_GT(film.estimate_error(pixel), 0.1);
    add_batch();
    EXPECT_EQ(film.estimate_error(pixel), 0.0);
    add(film, 0, 0, 2);
    EXPECT_EQ(film.estimate_error(pixel), 0.0) << "a batch that has begun says nothing";
    for (int k = 1; k < 16; ++k) add(film, 0, 0, 2);
    // Means of batches 1, 1, 1, 1, 2 have the variance 0.2.
    EXPECT_NEAR(film.estimate_error(pixel), std::sqrt(0.2 / 5) / 1.21, 1e-12);
}

TEST(FilmError, sees_from_256_samples_on_that_batches_of_64_agree) {
    Film film = make_film();
    const Window pixel{0, 0, 1, 1};
    for (int k = 0; k < 255; ++k) add(film, 0, 0, k % 64 < 16 ? 3.0f : 1.0f);
    EXPECT_GT(film.estimate_error(pixel), 0.05);
    add(film, 0, 0, 1);
    EXPECT_EQ(film.estimate_error(pixel), 0.0);
}

TEST(FilmError, is_none_of_equal_samples) {
    for (const float radiance : {0.05f, 0.1f, 0.7f, 1.3f, 3.0f}) {
        Film film = make_film();
        for (int k = 1; k <= 1100; ++k) {
            add(film, 0, 0, radiance);
            if (k > 1 && k % 16 == 0)
                ASSERT_LT(film.estimate_error({0, 0, 1, 1}), 1e-7) << radiance << " " << k;
        }
    }
}

TEST(FilmError, of_cleared_pixels_is_that_of_their_new_samples) {
    std::mt19937 random(3);
    Film film = make_film(), fresh = make_film();
    add_independent(film, 100, random);
    film.clear(kAll);
    for (int k = 0; k < 80; ++k) add(film, 1, 1, float(k % 7)), add(fresh, 1, 1, float(k % 7));
    EXPECT_EQ(film.estimate_error({1, 1, 2, 2}), fresh.estimate_error({1, 1, 2, 2}));
}

TEST(FilmError, is_kept_in_files) {
    std::mt19937 random(4);
    Film film = make_film(), read = make_film();
    add_independent(film, 70, random);
    std::stringstream bytes;
    film.write(bytes, "a picture");
    read.read(bytes, "a picture");
    EXPECT_EQ(read.estimate_error(kAll), film.estimate_error(kAll));
    std::mt19937 more(5), same(5);
    add_independent(film, 58, more), add_independent(read, 58, same);
    EXPECT_EQ(read.estimate_error(kAll), film.estimate_error(kAll));
}

TEST(FilmError, is_the_same_of_sums_of_batches_and_of_joined_films) {
    const Window pixel{0, 0, 1, 1};
    Film whole = make_film(), summed = make_film(), first = make_film(), second = make_film();
    for (uint32_t batch = 0; batch < 21; ++batch) {
        FilmSums sums;
        for (uint32_t k = 0; k < 16; ++k) {
            const float radiance = float((batch * batch + k * 3) % 7);
            add(whole, 0, 0, radiance);
            add(batch < 4 ? first : second, 0, 0, radiance);
            const double square = double(radiance) * radiance;
            ++sums.count, sums.radiance += Vec3f{radiance, radiance, radiance};
            sums.squares += Vec3<double>{square, square, square};
        }
        summed.add_sums(0, 0, sums);
    }
    first.join(second, 64);
    EXPECT_GT(whole.estimate_error(pixel), 0.0);
    EXPECT_EQ(summed.estimate_error(pixel), whole.estimate_error(pixel));
    EXPECT_EQ(first.estimate_error(pixel), whole.estimate_error(pixel));
}

} // namespace
} // namespace relief
