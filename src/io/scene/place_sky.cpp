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

/// Light from one cell of a sky.
struct SkyCell {
    Vec3f direction;
    double light = 0; ///< luminance times solid angle, as a part of the sphere
};

/// The sky in cells with the light of their texels: the time does not grow with normals times texels.
std::vector<SkyCell> reduce_sky(const Texture& sky) {
    const uint32_t columns = std::min(std::max(sky.width, 128u), 256u);
    const uint32_t rows = std::min(std::max(sky.height, 64u), 128u);
    std::vector<SkyCell> cells(size_t(columns) * rows);
    for (uint32_t k = 0; k < cells.size(); ++k)
        cells[k].direction = scalar::latlong_to_direction(
            Vec2f{(float(k % columns) + 0.5f) / float(columns), (float(k / columns) + 0.5f) / float(rows)});
    // Texels into cells; a small picture gives each of its cells the texel that it lies in.
    const uint32_t width = std::max(sky.width, columns), height = std::max(sky.height, rows);
    double weights = 0;
    for (uint32_t y = 0; y < height; ++y) {
        const double weight = std::sin(std::numbers::pi * (double(y) + 0.5) / height);
        weights += weight * width;
        for (uint32_t x = 0; x < width; ++x) {
            const uint32_t u = uint32_t(uint64_t(x) * sky.width / width);
            const uint32_t v = uint32_t(uint64_t(y) * sky.height / height);
            const uint32_t green = sky.channel_count < 3 ? 0 : 1, blue = 2 * green; // grey: one channel
            const Vec3f radiance{get_texel(sky, u, v, 0), get_texel(sky, u, v, green),
                                 get_texel(sky, u, v, blue)};
            const size_t cell = size_t(uint64_t(y) * rows / height) * columns + uint64_t(x) * columns / width;
            cells[cell].light += weight * double(scalar::luminance(radiance));
        }
    }
    for (SkyCell& cell : cells) cell.light /= weights;
    return cells;
}

/// Radiance of white diffuse surfaces of these normals under a sky that is not turned.
std::vector<double> measure_received(std::span<const SkyCell> sky, std::span<const Vec3f> normals) {
    std::vector<double> received(normals.size());
    for (const SkyCell& cell : sky)
        for (size_t k = 0; k < normals.size(); ++k)
            received[k] += cell.light * double(std::max(0.0f, dot(cell.direction, normals[k])));
    for (double& r : received) r *= 4; // the mean of max(0, cos) over the sphere is 1/4
    return received;
}

} // namespace

SkyPlacement place_sky(const Texture& texture, const Vec3f& view) {
    const std::vector<SkyCell> sky = reduce_sky(texture);
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
