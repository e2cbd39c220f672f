#include "samples/ocean.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/check.h"
#include "math/vec.h"
#include "math/vec_double.h"
#include "relief/half.h"
#include "samples/noise.h"

namespace relief::samples {

namespace {

using Complex = std::complex<double>;

constexpr double kGravity = 9.81; // m/s^2
constexpr double kTurn = 2 * std::numbers::pi;

Complex multiply(const Complex& a, const Complex& b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

/// Inverse transform without a factor: values[n] becomes the sum of values[k] exp(2 pi i k n / size), radix 2
/// (Cooley and Tukey 1965).
void transform(std::vector<Complex>& values, const std::vector<Complex>& roots) {
    const size_t size = values.size();
    for (size_t k = 1, reversed = 0; k < size; ++k) {
        size_t bit = size >> 1;
        for (; reversed & bit; bit >>= 1) reversed ^= bit;
        reversed ^= bit;
        if (k < reversed) std::swap(values[k], values[reversed]);
    }
    for (size_t half = 1; half < size; half *= 2)
        for (size_t begin = 0; begin < size; begin += 2 * half)
            for (size_t k = 0; k < half; ++k) {
                const Complex even = values[begin + k];
                const Complex odd = multiply(values[begin + k + half], roots[k * (size / (2 * half))]);
                values[begin + k] = even + odd, values[begin + k + half] = even - odd;
            }
}

/// Of a square, row after row.
void transform_square(std::vector<Complex>& values, size_t size) {
    std::vector<Complex> roots(size), line(size);
    for (size_t k = 0; k < size; ++k) roots[k] = std::polar(1.0, kTurn * double(k) / double(size));
    for (const auto& [step, stride] : {std::pair<size_t, size_t>(size, 1), {1, size}})
        for (size_t n = 0; n < size; ++n) {
            for (size_t k = 0; k < size; ++k) line[k] = values[n * step + k * stride];
            transform(line, roots);
            for (size_t k = 0; k < size; ++k) values[n * step + k * stride] = line[k];
        }
}

/// Two numbers of the normal distribution (Box and Muller 1958).
Complex draw_normal(Random& random) {
    const double radius = std::sqrt(-2 * std::log(1 - double(random.unit())));
    return std::polar(radius, kTurn * double(random.unit()));
}

} // namespace

Ocean::Ocean(const Config& config) : config_(config) {
    DCHECK(std::has_single_bit(config.size));
    const uint32_t size = config_.size;
    Random random(config_.seed);
    std::vector<Complex> amplitudes;
    for (uint32_t row = 0; row < size; ++row)
        for (uint32_t column = 0; column < size; ++column) {
            const Complex normal = draw_normal(random);
            const double power = compute_power(get_wave_number(column), get_wave_number(row));
            amplitudes.push_back(normal * std::sqrt(power / 2));
        }
    double variance = 0;
    for (uint32_t row = 0; row < size; ++row)
        for (uint32_t column = 0; column < size; ++column) {
            waves_.push_back(make_wave(column, row, amplitudes));
            variance += std::norm(waves_.back().there + waves_.back().back);
        }
    const double scale = config_.height / 4 / std::sqrt(variance);
    for (Wave& wave : waves_) wave.there *= scale, wave.back *= scale;
}

/// Of a column or row of the transform, radians a metre.
double Ocean::get_wave_number(uint32_t index) const {
    const double count = index < config_.size / 2 ? double(index) : double(index) - double(config_.size);
    return kTurn * count / config_.tile;
}

/// Phillips' spectrum (Tessendorf 2001, eq. 40 and 41), up to a factor; waves against the wind are weak.
double Ocean::compute_power(double kx, double kz) const {
    const double square = kx * kx + kz * kz;
    if (square == 0) return 0;
    const double longest = config_.wind_speed * config_.wind_speed / kGravity;
    const double cut = config_.shortest / kTurn;
    const double angle = config_.wind_degrees * kTurn / 360;
    const double along = (kx * std::cos(angle) + kz * std::sin(angle)) / std::sqrt(square);
    constexpr double kAgainst = 0.05;
    return std::exp(-1 / (square * longest * longest) - square * cut * cut) / (square * square) * along *
           along * (along < 0 ? kAgainst : 1);
}

Ocean::Wave Ocean::make_wave(uint32_t column, uint32_t row, const std::vector<Complex>& amplitudes) const {
    const uint32_t size = config_.size, last = size - 1;
    Wave wave;
    if (column == size / 2 || row == size / 2) return wave; // has no opposite
    const double kx = get_wave_number(column), kz = get_wave_number(row), k = compute_length(kx, kz);
    if (k == 0) return wave;
    wave.there = amplitudes[row * size + column];
    wave.back = std::conj(amplitudes[((size - row) & last) * size + ((size - column) & last)]);
    wave.x = kx / k, wave.z = kz / k;
    wave.frequency = std::sqrt(kGravity * k);
    return wave;
}

std::shared_ptr<const Texture> Ocean::make_map(double seconds) const {
    const size_t count = waves_.size();
    // x and z are real, so that one transform makes both: x + i z.
    std::vector<Complex> height(count), sideways(count);
    for (size_t k = 0; k < count; ++k) {
        const Wave& wave = waves_[k];
        const Complex phase = std::polar(1.0, -wave.frequency * seconds);
        height[k] = multiply(wave.there, phase) + multiply(wave.back, std::conj(phase));
        // Points move towards the crests: by i k / |k| times the height.
        sideways[k] = multiply(multiply(height[k], {0, 1}), {wave.x, wave.z}) * config_.choppiness;
    }
    transform_square(height, config_.size);
    transform_square(sideways, config_.size);
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = config_.size;
    texture->channel_count = 3;
    texture->file = "ocean";
    texture->source_type = SampleType::float16;
    for (size_t k = 0; k < count; ++k)
        for (const double value : {sideways[k].real(), height[k].real(), sideways[k].imag(), 1.0})
            texture->halves.push_back(float_to_half(float(value)));
    return texture;
}

Vec3f Ocean::displace(const Texture& map, double x, double z) const {
    const auto size = int32_t(config_.size);
    const double column = x / config_.tile * size - 0.5, row = z / config_.tile * size - 0.5;
    const double left = std::floor(column), top = std::floor(row);
    Vec3f result;
    for (int32_t k = 0; k < 4; ++k) {
        const int32_t dx = k % 2, dz = k / 2;
        const double weight = std::fabs((1 - dx) - (column - left)) * std::fabs((1 - dz) - (row - top));
        const size_t at = 4 * (size_t(wrap(int32_t(top) + dz, size)) * config_.size +
                               size_t(wrap(int32_t(left) + dx, size)));
        result += Vec3f{half_to_float(map.halves[at]), half_to_float(map.halves[at + 1]),
                        half_to_float(map.halves[at + 2])} *
                  float(weight);
    }
    return result;
}

double Ocean::measure_least_area(const Texture& map) const {
    const double cell = config_.tile / config_.size;
    double least = 1;
    for (uint32_t row = 0; row < config_.size; ++row)
        for (uint32_t column = 0; column < config_.size; ++column) {
            const auto at = [&](uint32_t dx, uint32_t dz) {
                return displace(map, (column + dx + 0.5) * cell, (row + dz + 0.5) * cell);
            };
            const Vec3f here = at(0, 0), right = at(1, 0), below = at(0, 1);
            const double xx = cell + double(right.x - here.x), xz = double(right.z - here.z);
            const double zz = cell + double(below.z - here.z), zx = double(below.x - here.x);
            least = std::min(least, (xx * zz - xz * zx) / (cell * cell));
        }
    return least;
}

} // namespace relief::samples
