// The measures of parity find what they are for, and nothing else.
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "gpu/parity.h"
#include "relief/samples.h"

namespace relief::gpu {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

Image make_hits(float depth) {
    Image image;
    image.width = image.full_width = 2, image.height = image.full_height = 1;
    image.channels = {"depth.Z", "id.I"};
    image.pixels = {depth, depth == kInfinity ? 0.0f : 1.0f, 3, 2};
    return image;
}

TEST(Parity, tells_hits_that_differ) {
    EXPECT_EQ(compare_hits(make_hits(1), make_hits(1)).share(), 0);
    EXPECT_EQ(compare_hits(make_hits(1), make_hits(kInfinity)).one_only, 1u);
    EXPECT_EQ(compare_hits(make_hits(1), make_hits(1.001f)).other_depth, 1u);
    Image other = make_hits(1);
    other.pixels[1] = 7;
    EXPECT_EQ(compare_hits(make_hits(1), other).other_id, 1u);
    EXPECT_EQ(compare_hits(make_hits(1), other).share(), 0.5);
    EXPECT_NEAR(compare_hits(make_hits(1), make_hits(1.00001f)).largest_depth_difference, 1e-5, 1e-6);
    EXPECT_EQ(compare_hits(make_hits(kInfinity), make_hits(kInfinity)).share(), 0);
}

TEST(Parity, two_renders_of_other_samples_agree_and_a_brighter_one_does_not) {
    Scene scene = make_sample_scene("ear", Instancing::none);
    RenderSettings settings;
    settings.image.width = 64, settings.image.height = 48;
    settings.image.spp = 16, settings.image.bounces = 1;
    settings.image.layers = {"variance"};
    const Image a = render(scene, settings).image;
    settings.image.seed = 1;
    const Image b = render(scene, settings).image;
    EXPECT_GT(compute_largest_z(a, b), 0.5);
    EXPECT_LE(compute_largest_z(a, b), kLargestZ);
    ASSERT_TRUE(scene.environment);
    scene.environment->strength *= 1.5f;
    EXPECT_GT(compute_largest_z(a, render(scene, settings).image), kLargestZ);
}

} // namespace
} // namespace relief::gpu
