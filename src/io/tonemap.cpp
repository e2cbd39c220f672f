#include "io/tonemap.h"

#include <algorithm>
#include <cmath>

#include "math/vec.h"

namespace relief {

namespace {

constexpr float kExposure = 1.5f; // puts 0.18 on 0.186

float apply_curve(float v) {
    return (v * (v + 0.0245786f) - 0.000090537f) / (v * (0.983729f * v + 0.4329510f) + 0.238081f);
}

float make_finite(float value) { return value > 0 ? std::min(value, 1e6f) : 0; }

} // namespace

Vec3f apply_filmic_curve(const Vec3f& radiance) {
    const Vec3f c =
        Vec3f{make_finite(radiance.x), make_finite(radiance.y), make_finite(radiance.z)} * kExposure;
    const Vec3f wide{dot(Vec3f{0.59719f, 0.35458f, 0.04823f}, c), dot(Vec3f{0.07600f, 0.90834f, 0.01566f}, c),
                     dot(Vec3f{0.02840f, 0.13383f, 0.83777f}, c)};
    const Vec3f shaped{apply_curve(wide.x), apply_curve(wide.y), apply_curve(wide.z)};
    const Vec3f narrow{dot(Vec3f{1.60475f, -0.53108f, -0.07367f}, shaped),
                       dot(Vec3f{-0.10208f, 1.10813f, -0.00605f}, shaped),
                       dot(Vec3f{-0.00327f, -0.07276f, 1.07602f}, shaped)};
    return {std::clamp(narrow.x, 0.0f, 1.0f), std::clamp(narrow.y, 0.0f, 1.0f),
            std::clamp(narrow.z, 0.0f, 1.0f)};
}

float encode_srgb(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

float decode_srgb(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

} // namespace relief
