#include "io/scene/place_sky.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "formulas/bsdf.h"
#include "formulas/environment.h"
#include "io/scene/asset_cache.h"

namespace relief {

namespace {

/// Normals of surfaces that the camera sees, spread evenly.
std::vector<Vec3f> make_visible_normals(const Vec3f& view) {
    std::vector<Vec3f> normals = {view};
    constexpr int kCount = 64;
    constexpr float kGoldenAngle = 2.3999632f;
    for (int k = 0; k < kCount; ++k) {
        const float y = 1 - 2 * (float(k) + 0.5f) / kCount, radius = std::sqrt(1 - y * y);
        const float turn = kGoldenAngle * float(k);
        const Vec3f normal{radius * std::sin(turn), y, radius * std::cos(turn)};
        if (dot(normal, view) > 0.2f) normals.push_back(normal);
    }
    return normals;
}

/// A direction of the world in a sky turned by `degrees`, as `turn_into_environment` does.
Vec3f turn_into_sky(const Vec3f& d, float degrees) {
    const float s = std::sin(degrees * std::numbers::pi_v<float> / 180);
    const float c = std::cos(degrees * std::numbers::pi_v<float> / 180);
    return {d.x * c - d.z * s, d.y, d.x * s + d.z * c};
}

/// Radiance of white diffuse surfaces of these normals under a sky that is not turned.
std::vector<double> measure_received(const Texture& sky, std::span<const Vec3f> normals) {
    std::vector<double> received(normals.size());
    double weights = 0;
    const uint32_t columns = std::max(sky.width, 128u), rows = std::max(sky.height, 64u);
    for (uint32_t row = 0; row < rows; ++row) {
        const float v = (float(row) + 0.5f) / float(rows);
        const uint32_t y = uint32_t(uint64_t(row) * sky.height / rows);
        const double weight = std::sin(std::numbers::pi * double(v));
        weights += weight * columns;
        for (uint32_t column = 0; column < columns; ++column) {
            const uint32_t x = uint32_t(uint64_t(column) * sky.width / columns);
            const Vec3f radiance{get_texel(sky, x, y, 0), get_texel(sky, x, y, 1), get_texel(sky, x, y, 2)};
            const double light = weight * double(scalar::luminance(radiance));
            const Vec3f direction =
                scalar::latlong_to_direction(Vec2f{(float(column) + 0.5f) / float(columns), v});
            for (size_t k = 0; k < normals.size(); ++k)
                received[k] += light * double(std::max(0.0f, dot(direction, normals[k])));
        }
    }
    // The mean of max(0, cos) over the sphere is 1/4.
    for (double& r : received) r *= 4 / weights;
    return received;
}

} // namespace

SkyPlacement place_sky(const Texture& sky, const Vec3f& view) {
    constexpr float kStep = 15; // degrees
    const Vec3f side = cross(view, Vec3f{0, 1, 0});
    const Vec3f left = length(side) > 1e-3f ? normalize(side) : Vec3f{-1, 0, 0};
    const Vec3f lit = normalize(view + left * 0.7f + Vec3f{0, 0.4f, 0});
    std::vector<Vec3f> turned;
    for (float degrees = 0; degrees < 360; degrees += kStep) turned.push_back(turn_into_sky(lit, degrees));
    const std::vector<double> by_turn = measure_received(sky, turned);
    SkyPlacement placement;
    const auto best = std::max_element(by_turn.begin(), by_turn.end());
    // A sky that is the same on all sides stays as it is.
    if (*best > 1.001 * by_turn.front()) placement.rotate_degrees = kStep * float(best - by_turn.begin());
    std::vector<Vec3f> normals = make_visible_normals(view);
    for (Vec3f& normal : normals) normal = turn_into_sky(normal, placement.rotate_degrees);
    const std::vector<double> received = measure_received(sky, normals);
    const double brightest = *std::max_element(received.begin(), received.end());
    if (brightest > 0) placement.strength = float(1 / brightest);
    return placement;
}

} // namespace relief
