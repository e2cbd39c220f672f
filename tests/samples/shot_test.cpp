// The sample scene that moves, and the ocean in it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "math/vec.h"
#include "relief/error.h"
#include "relief/half.h"
#include "relief/samples.h"
#include "samples/ocean.h"

namespace relief {
namespace {

using samples::Ocean;

constexpr Ocean::Config kConfig;

double get_channel(const Texture& map, size_t texel, size_t channel) {
    return double(half_to_float(map.halves[4 * texel + channel]));
}

/// Mean product of two channels, which have no mean of their own.
double correlate(const Texture& map, const std::vector<double>& other) {
    double sum = 0;
    for (size_t k = 0; k < other.size(); ++k) sum += get_channel(map, k, 1) * other[k];
    return sum / double(other.size());
}

TEST(Ocean, is_as_high_as_asked_for_and_level) {
    Ocean::Config config;
    config.height = 1.5;
    for (const double seconds : {0.0, 20.0}) {
        const auto map = Ocean(config).make_map(seconds);
        double sum = 0, square = 0;
        const size_t count = map->halves.size() / 4;
        for (size_t k = 0; k < count; ++k)
            sum += get_channel(*map, k, 1), square += std::pow(get_channel(*map, k, 1), 2);
        EXPECT_NEAR(sum / double(count), 0, 1e-3);
        EXPECT_NEAR(4 * std::sqrt(square / double(count)), 1.5, seconds == 0 ? 1e-3 : 0.5);
    }
}

TEST(Ocean, is_that_of_its_seed_and_moves) {
    const auto map = Ocean(kConfig).make_map(0.5);
    EXPECT_EQ(map->halves, Ocean(kConfig).make_map(0.5)->halves);
    EXPECT_NE(map->halves, Ocean(kConfig).make_map(0.6)->halves);
    Ocean::Config other;
    other.seed = kConfig.seed + 1;
    EXPECT_NE(map->halves, Ocean(other).make_map(0.5)->halves);
}

TEST(Ocean, repeats_without_a_seam) {
    const Ocean ocean(kConfig);
    const auto map = ocean.make_map(0);
    const double cell = kConfig.tile / kConfig.size;
    const auto size = size_t(kConfig.size);
    const auto at = [&](size_t row, size_t column) {
        return get_channel(*map, (row % size) * size + column % size, 1);
    };
    double most = 0, most_at_seam = 0;
    for (size_t row = 0; row < size; ++row)
        for (size_t column = 0; column < size; ++column) {
            const double step = std::max(std::fabs(at(row, column + 1) - at(row, column)),
                                         std::fabs(at(row + 1, column) - at(row, column)));
            double& greatest = row + 1 == size || column + 1 == size ? most_at_seam : most;
            greatest = std::max(greatest, step);
        }
    EXPECT_LE(most_at_seam, most);
    for (const double x : {0.0, 3.3, 31.99})
        EXPECT_LT(
            length(ocean.displace(*map, x, 7) - ocean.displace(*map, x + kConfig.tile, 7 - kConfig.tile)),
            1e-4f);
    EXPECT_NEAR(double(ocean.displace(*map, 10.5 * cell, 3.5 * cell).y), at(3, 10), 1e-6);
}

TEST(Ocean, has_narrow_crests_and_wide_troughs) {
    const auto map = Ocean(kConfig).make_map(1);
    const auto size = size_t(kConfig.size);
    std::vector<double> spread; // of the water around each texel, along both axes
    for (size_t row = 0; row < size; ++row)
        for (size_t column = 0; column < size; ++column)
            spread.push_back(get_channel(*map, row * size + (column + 1) % size, 0) -
                             get_channel(*map, row * size + (column + size - 1) % size, 0) +
                             get_channel(*map, (row + 1) % size * size + column, 2) -
                             get_channel(*map, (row + size - 1) % size * size + column, 2));
    double square = 0;
    for (const double value : spread) square += value * value;
    square /= double(spread.size());
    const double height = kConfig.height / 4;
    EXPECT_LT(correlate(*map, spread) / (height * std::sqrt(square)), -0.3);
}

/// Waves that go one way for an eighth of a period are where they were, but further.
TEST(Ocean, goes_with_the_wind) {
    const Ocean ocean(kConfig);
    const auto before = ocean.make_map(0), after = ocean.make_map(0.4);
    const double angle = kConfig.wind_degrees * 3.14159265358979 / 180;
    const auto compare = [&](double distance) {
        double sum = 0;
        for (double z = 0; z < kConfig.tile; z += 0.5)
            for (double x = 0; x < kConfig.tile; x += 0.5)
                sum +=
                    double(ocean.displace(*before, x, z).y) *
                    double(
                        ocean.displace(*after, x + distance * std::cos(angle), z + distance * std::sin(angle))
                            .y);
        return sum;
    };
    EXPECT_GT(compare(1.8), compare(0));
    EXPECT_GT(compare(0), compare(-1.8));
}

const SceneMotion& motion() {
    static const SceneMotion made = make_sample_motion("shot");
    return made;
}

TEST(ShotScene, has_24_frames_of_all_that_moves) {
    const Scene scene = make_sample_scene("shot", Instancing::shared);
    validate_scene(scene);
    EXPECT_EQ(scene.picture.fps, 24);
    EXPECT_LT(scene.camera.shutter_open, scene.camera.shutter_close);
    EXPECT_EQ(motion().first_frame, 1);
    EXPECT_EQ(motion().frame_count, 24u);
    ASSERT_EQ(motion().maps.size(), 1u);
    const auto& maps = motion().maps.at(scene.displacements[0].name);
    EXPECT_EQ(maps.size(), 24u);
    EXPECT_EQ(maps[0]->halves, scene.displacements[0].tiles[0].texture->halves);
    EXPECT_GE(motion().objects.size(), 3u);
    EXPECT_EQ(make_sample_motion("ear").frame_count, 0u);
    EXPECT_THROW(make_sample_motion("shoot"), Error);
}

TEST(ShotScene, has_water_that_never_folds_over) {
    const Ocean ocean(kConfig);
    for (const auto& map : motion().maps.at("ocean")) EXPECT_GT(ocean.measure_least_area(*map), 0.05);
}

TEST(ShotScene, keeps_its_bodies_afloat) {
    const Ocean ocean(kConfig);
    for (const auto& [name, placements] : motion().objects)
        for (size_t frame = 0; frame < placements.size(); ++frame) {
            const Texture& map = *motion().maps.at("ocean")[frame];
            const Vec3f& body = placements[frame].translate;
            float nearest = std::numeric_limits<float>::infinity(), water = 0;
            for (float dx = -1.5f; dx <= 1.5f; dx += 0.05f)
                for (float dz = -1.5f; dz <= 1.5f; dz += 0.05f) {
                    const float x = body.x + dx, z = body.z + dz;
                    const Vec3f moved = ocean.displace(map, double(x), double(z));
                    const float distance = std::hypot(dx + moved.x, dz + moved.z);
                    if (distance < nearest) nearest = distance, water = moved.y;
                }
            EXPECT_LT(nearest, 0.1f);
            EXPECT_NEAR(body.y, water + 0.1f, 0.12f) << name << " " << frame;
            EXPECT_LT(std::fabs(placements[frame].rotate_degrees.x), 30);
            EXPECT_LT(std::fabs(placements[frame].rotate_degrees.z), 30);
        }
}

} // namespace
} // namespace relief
