// Texture look-ups and the environment as a light, below the path tracer.
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "cpu/shading/environment_light.h"
#include "cpu/shading/textures.h"
#include "formulas/environment.h"
#include "formulas/sobol.h"
#include "formulas/warp.h"
#include "relief/half.h"

namespace relief {
namespace {

/// 2 x 2 texels, red 0 1 / 2 3 (row 0 on top); green is ten times that.
Texture make_texture(uint32_t channel_count) {
    Texture texture;
    texture.width = texture.height = 2;
    texture.channel_count = channel_count;
    for (float r : {0.0f, 1.0f, 2.0f, 3.0f})
        texture.floats.insert(texture.floats.end(), {r, channel_count > 1 ? 10 * r : 0, 0.0f, 1.0f});
    return texture;
}

TEST(ShadingTextures, have_row_zero_at_v_one_and_are_bilinear_between_centres) {
    const Texture texture = make_texture(3);
    EXPECT_FLOAT_EQ(cpu::fetch_texture(texture, {0.25f, 0.75f}).x, 0);
    EXPECT_FLOAT_EQ(cpu::fetch_texture(texture, {0.75f, 0.75f}).x, 1);
    EXPECT_FLOAT_EQ(cpu::fetch_texture(texture, {0.25f, 0.25f}).x, 2);
    EXPECT_FLOAT_EQ(cpu::fetch_texture(texture, {0.5f, 0.5f}).y, 15);
    EXPECT_FLOAT_EQ(cpu::fetch_texture(texture, {0.5f, 0.75f}).x, 0.5f);
}

TEST(ShadingTextures, repeat_in_both_directions) {
    const Texture texture = make_texture(3);
    for (float du : {-3.0f, 1.0f, 1000.0f})
        for (float dv : {-2.0f, 5.0f})
            EXPECT_NEAR(cpu::fetch_texture(texture, {0.6f + du, 0.3f + dv}).y,
                        cpu::fetch_texture(texture, {0.6f, 0.3f}).y, 2e-3);
    EXPECT_FLOAT_EQ(cpu::fetch_texture(texture, {0.0f, 0.75f}).x, 0.5f); // half way around to the last column
}

TEST(ShadingTextures, are_grey_with_one_channel_and_survive_wild_coordinates) {
    EXPECT_FLOAT_EQ(cpu::fetch_texture(make_texture(1), {0.75f, 0.25f}).z, 3);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(cpu::fetch_texture(make_texture(3), {nan, 0}).x, 0);
    EXPECT_TRUE(std::isfinite(cpu::fetch_texture(make_texture(3), {1e30f, -1e30f}).x));
}

TEST(ShadingTextures, read_halves_like_floats) {
    Texture texture = make_texture(3);
    texture.floats.clear();
    for (uint16_t r : {0x0000, 0x3c00, 0x4000, 0x4200})
        texture.halves.insert(texture.halves.end(), {r, r, r, 0x3c00});
    EXPECT_FLOAT_EQ(cpu::fetch_texture(texture, {0.5f, 0.5f}).x, 1.5f);
}

TEST(Half, converts_every_kind_of_number) {
    EXPECT_EQ(half_to_float(0x3c00), 1.0f);
    EXPECT_EQ(half_to_float(0xc500), -5.0f);
    EXPECT_EQ(half_to_float(0x7bff), 65504.0f);
    EXPECT_EQ(half_to_float(0x0001), 0x1p-24f);
    EXPECT_EQ(half_to_float(0x83ff), -0x3ffp-24f);
    EXPECT_EQ(half_to_float(0x7c00), std::numeric_limits<float>::infinity());
    EXPECT_TRUE(std::isnan(half_to_float(0x7e01)));
    EXPECT_TRUE(std::signbit(half_to_float(0x8000)));
}

/// A sky with a bright spot, black elsewhere below the horizon; sizes that do and do not fit the density's
/// cells.
Environment make_sky(uint32_t width, uint32_t height, float spot = 300) {
    auto texture = std::make_shared<Texture>();
    texture->width = width, texture->height = height, texture->channel_count = 3;
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            float value = y < height / 2 ? 0.5f : 0.0f;
            if (x == width / 3 && y == height / 4) value = spot;
            texture->floats.insert(texture->floats.end(), {value, value, value, 1.0f});
        }
    Environment environment;
    environment.texture = texture;
    environment.rotate_degrees = 35;
    return environment;
}

TEST(ShadingEnvironment, has_a_density_that_integrates_to_one_and_covers_all_light) {
    for (uint32_t width : {1u, 7u, 64u, 1500u}) {
        const cpu::EnvironmentLight light(make_sky(width, std::max(2u, width / 2)));
        double integral = 0;
        const uint32_t n = 1u << 16;
        for (uint32_t k = 0; k < n; ++k) {
            const Vec3f d = normalize(scalar::square_to_sphere(scalar::sobol_pair(1, k, 0)));
            const float pdf = light.pdf(d);
            if (std::fabs(d.y) < 0.9999f) integral += pdf * 4 * std::numbers::pi / n; // infinite at the poles
            if (light.radiance(d).x > 0) ASSERT_GT(pdf, 0) << width;
        }
        EXPECT_NEAR(integral, 1, width < 1000 ? 0.02 : 0.4) << width; // a spot of few texels is seldom met
    }
}

TEST(ShadingEnvironment, still_draws_what_is_dim_beside_a_lamp_in_the_same_row) {
    const cpu::EnvironmentLight light(make_sky(1024, 512, 3e7f));
    for (uint32_t column = 0; column < 1024; ++column) {
        const Vec2f position{(float(column) + 0.5f) / 1024, (512 / 4 + 0.5f) / 512};
        const Vec3f local = scalar::latlong_to_direction(position);
        const float turn = 35 * std::numbers::pi_v<float> / 180;
        const Vec3f direction{local.x * std::cos(turn) + local.z * std::sin(turn), local.y,
                              local.z * std::cos(turn) - local.x * std::sin(turn)};
        ASSERT_GT(light.look_up(direction).radiance.x, 0) << column;
        ASSERT_GT(light.look_up(direction).pdf, 0) << column;
    }
}

TEST(ShadingEnvironment, gives_a_drawn_direction_the_radiance_and_density_of_a_look_up) {
    const cpu::EnvironmentLight light(make_sky(64, 32));
    for (uint32_t k = 0; k < 1000; ++k) {
        const auto drawn = light.draw_direction(scalar::sobol_pair(3, k, 0));
        const Vec3f radiance = light.radiance(drawn.direction);
        ASSERT_NEAR(light.radiance(drawn.position).x, radiance.x, 1e-3f * radiance.x + 1e-3f) << k;
        // On the border of two cells rounding may name the neighbour.
        const float x = drawn.position.x * 64, y = drawn.position.y * 32;
        if (std::fabs(x - std::round(x)) < 1e-3f || std::fabs(y - std::round(y)) < 1e-3f) continue;
        ASSERT_NEAR(light.pdf(drawn.direction), drawn.pdf, 1e-3f * drawn.pdf) << k;
    }
}

TEST(ShadingEnvironment, draws_with_the_density_that_it_names_and_without_bias) {
    for (uint32_t width : {7u, 64u, 1500u}) {
        const cpu::EnvironmentLight light(make_sky(width, width / 2));
        double sum = 0, up = 0;
        const uint32_t n = 1u << 14;
        for (uint32_t k = 0; k < n; ++k) {
            const auto drawn = light.draw_direction(scalar::sobol_pair(2, k, 0));
            ASSERT_GT(drawn.pdf, 0);
            ASSERT_NEAR(length(drawn.direction), 1, 1e-5);
            sum += light.radiance(drawn.direction).x / drawn.pdf / n;
            up += drawn.direction.y / n;
        }
        // Within coarse texels the sine varies, and the light's own mean is an estimate.
        const double tolerance = width < 10 ? 0.15 : 0.02;
        EXPECT_NEAR(sum / (4 * std::numbers::pi) / light.mean_luminance(), 1, tolerance) << width;
        EXPECT_GT(up, 0.2);
    }
}

} // namespace
} // namespace relief
