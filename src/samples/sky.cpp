#include <algorithm>
#include <cmath>

#include "math/vec.h"
#include "samples/angles.h"
#include "samples/noise.h"
#include "samples/stage.h"

namespace relief::samples {

namespace {

Vec3f sky_radiance(const Vec3f& direction, const Vec3f& to_sun, const Vec3f& sun_color) {
    const float up = direction.y, towards = std::max(dot(direction, to_sun), 0.0f);
    const Vec3f zenith{0.16f, 0.30f, 0.62f}, middle{0.42f, 0.56f, 0.78f}, horizon{0.95f, 0.84f, 0.70f};
    const Vec3f ground{0.24f, 0.20f, 0.17f};
    const float h = std::max(up, 0.0f);
    Vec3f color =
        lerp(lerp(horizon, middle, smooth_step(0.0f, 0.28f, h)), zenith, smooth_step(0.2f, 0.95f, h));
    const Vec3f clouded = direction * (1.0f / (0.25f + h));
    const float cloud =
        smooth_step(0.05f, 0.55f, fractal_noise({1.6f * clouded.x, 3, 1.6f * clouded.z}, 5, 231));
    color = lerp(color, Vec3f{1.05f, 0.98f, 0.92f}, 0.55f * cloud * smooth_step(0.02f, 0.25f, h));
    const float glow =
        0.5f * std::pow(towards, 6.0f) + 1.6f * std::pow(towards, 60.0f) + 6.0f * std::pow(towards, 900.0f);
    color += sun_color * glow;
    return lerp(ground, color, smooth_step(-0.06f, 0.02f, up));
}

} // namespace

Vec3f sky_direction(float azimuth_degrees, float height_degrees) {
    const float azimuth = azimuth_degrees * kPi / 180, height = height_degrees * kPi / 180;
    return {std::cos(height) * std::sin(azimuth), std::sin(height), -std::cos(height) * std::cos(azimuth)};
}

std::shared_ptr<const Texture> make_sky(const Vec3f& to_sun, const Vec3f& sun_color) {
    auto texture = std::make_shared<Texture>();
    texture->width = 512, texture->height = 256;
    texture->channel_count = 3;
    texture->file = "sky";
    for (uint32_t y = 0; y < texture->height; ++y)
        for (uint32_t x = 0; x < texture->width; ++x) {
            const float u = (float(x) + 0.5f) / float(texture->width),
                        v = (float(y) + 0.5f) / float(texture->height);
            const Vec3f color = sky_radiance(sky_direction(360 * u - 180, 90 - 180 * v), to_sun, sun_color);
            texture->floats.insert(texture->floats.end(), {color.x, color.y, color.z, 1.0f});
        }
    return texture;
}

} // namespace relief::samples
