#include "samples/noise.h"

namespace relief::samples {

namespace {

struct Cell {
    int32_t index;
    float fraction, weight;
};

/// Rounds towards minus infinity without a call, which std::floor is on processors without SSE4.
Cell locate(float x) {
    auto index = int32_t(x);
    if (float(index) > x) --index;
    const float f = x - float(index);
    return {index, f, f * f * f * (f * (f * 6 - 15) + 10)};
}

/// Dot product with one of the twelve edge directions of a cube.
float dot_gradient(uint32_t bits, float x, float y, float z) {
    const uint32_t h = bits >> 28;
    const float u = h < 8 ? x : y, v = h < 4 ? y : (h == 12 || h == 14 ? x : z);
    return ((h & 1) ? -u : u) + ((h & 2) ? -v : v);
}

/// Dot product with one of eight directions of the plane.
float dot_gradient(uint32_t bits, float x, float y) {
    const uint32_t h = bits >> 29;
    const float u = h < 4 ? x : y, v = h < 4 ? y : x;
    return ((h & 1) ? -u : u) + 0.5f * ((h & 2) ? -v : v);
}

template <class Octave> float sum_octaves(int octaves, const Octave& octave) {
    float sum = 0, weight = 0.5f;
    for (int k = 0; k < octaves; ++k, weight *= 0.5f) sum += weight * octave(k);
    return sum * 1.6f;
}

template <class Octave> float sum_ridges(int octaves, const Octave& octave) {
    float sum = 0, weight = 0.5f, previous = 1;
    for (int k = 0; k < octaves; ++k, weight *= 0.5f) {
        const float ridge = 1 - std::fmin(std::fabs(octave(k)) * 1.6f, 1.0f);
        sum += weight * ridge * ridge * previous;
        previous = ridge;
    }
    return sum * 1.2f;
}

} // namespace

uint32_t hash(int32_t x, int32_t y, int32_t z, uint32_t seed) {
    uint32_t h = seed * 0x27d4eb2fu ^ uint32_t(x) * 0x8da6b343u ^ uint32_t(y) * 0xd8163841u ^
                 uint32_t(z) * 0xcb1ab31fu;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    return h ^ (h >> 15);
}

float noise(const Vec3f& p, uint32_t seed) {
    const Cell x = locate(p.x), y = locate(p.y), z = locate(p.z);
    float planes[2];
    for (int k = 0; k < 2; ++k) {
        float rows[2];
        for (int j = 0; j < 2; ++j) {
            const float fy = y.fraction - float(j), fz = z.fraction - float(k);
            const float a = dot_gradient(hash(x.index, y.index + j, z.index + k, seed), x.fraction, fy, fz);
            const float b =
                dot_gradient(hash(x.index + 1, y.index + j, z.index + k, seed), x.fraction - 1, fy, fz);
            rows[j] = lerp(a, b, x.weight);
        }
        planes[k] = lerp(rows[0], rows[1], y.weight);
    }
    return lerp(planes[0], planes[1], z.weight);
}

float tile_noise(const Vec2f& p, int period_x, int period_y, uint32_t seed) {
    const Cell x = locate(p.x), y = locate(p.y);
    // Divisions are most of what a wrap takes.
    const int32_t x0 = wrap(x.index, period_x), x1 = x0 + 1 == period_x ? 0 : x0 + 1;
    const int32_t y0 = wrap(y.index, period_y);
    float rows[2];
    for (int j = 0; j < 2; ++j) {
        const int32_t row = y0 + j == period_y ? 0 : y0 + j;
        const float fy = y.fraction - float(j);
        const float a = dot_gradient(hash(x0, row, 0, seed), x.fraction, fy);
        const float b = dot_gradient(hash(x1, row, 0, seed), x.fraction - 1, fy);
        rows[j] = lerp(a, b, x.weight);
    }
    return 1.3f * lerp(rows[0], rows[1], y.weight);
}

float fractal_noise(const Vec3f& p, int octaves, uint32_t seed) {
    return sum_octaves(octaves, [&](int k) { return noise(p * float(1 << k), seed + uint32_t(k)); });
}

float fractal_tile_noise(const Vec2f& p, int period_x, int period_y, int octaves, uint32_t seed) {
    return sum_octaves(octaves, [&](int k) {
        return tile_noise(p * float(1 << k), period_x << k, period_y << k, seed + uint32_t(k));
    });
}

float ridged_noise(const Vec3f& p, int octaves, uint32_t seed) {
    return sum_ridges(octaves, [&](int k) { return noise(p * float(1 << k), seed + uint32_t(k)); });
}

float ridged_tile_noise(const Vec2f& p, int period_x, int period_y, int octaves, uint32_t seed) {
    return sum_ridges(octaves, [&](int k) {
        return tile_noise(p * float(1 << k), period_x << k, period_y << k, seed + uint32_t(k));
    });
}

} // namespace relief::samples
