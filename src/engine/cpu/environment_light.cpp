#include "engine/cpu/environment_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "base/parallel.h"
#include "engine/cpu/textures.h"
#include "math/scalar.h"

namespace relief::cpu {

namespace {

constexpr uint32_t kMaxCellsX = 1024, kMaxCellsY = 512;

struct Interval {
    uint32_t index;
    float position; ///< within the interval, [0, 1)
};

/// Interval of a cumulative distribution (0 ... 1) that u falls into; never one of zero width.
Interval find_interval(std::span<const float> cumulative, float u) {
    const auto above = std::upper_bound(cumulative.begin() + 1, cumulative.end() - 1, u);
    const uint32_t index = uint32_t(above - cumulative.begin()) - 1;
    const float width = cumulative[index + 1] - cumulative[index];
    const float position = width > 0 ? (u - cumulative[index]) / width : 0.5f;
    return {index, std::min(position, 0x1.fffffep-1f)};
}

/// Turns weights that start at values[1] into cumulative probabilities; returns their sum. What is dim beside a
/// lamp gets a share that floats can still tell from nothing: in the lamp's shadow it is all the light there is.
double accumulate(std::span<float> values) {
    constexpr double kLeastShare = 0.01; // of the mean weight
    double sum = 0;
    for (size_t i = 1; i < values.size(); ++i) sum += values[i];
    const double least = kLeastShare * sum / double(values.size() - 1);
    const auto raise = [least](float weight) { return weight > 0 ? std::max(double(weight), least) : 0.0; };
    double raised = 0;
    for (size_t i = 1; i < values.size(); ++i) raised += raise(values[i]);
    double running = 0;
    values[0] = 0;
    for (size_t i = 1; i < values.size(); ++i) {
        running += raise(values[i]);
        values[i] = sum > 0 ? float(running / raised) : float(i) / float(values.size() - 1);
    }
    values.back() = 1;
    return sum;
}

/// Integral of the bilinearly filtered luminance over each texel of a row, in texels: so it is positive
/// wherever the filtered radiance is.
std::vector<double> integrate_row(const Texture& texture, uint32_t row, const Vec3f& scale) {
    const uint32_t above = row > 0 ? row - 1 : 0, below = std::min(row + 1, texture.height - 1);
    std::vector<double> filtered(texture.width), result(texture.width);
    const auto brightness = [&](uint32_t x, uint32_t y) {
        const float value = scalar::luminance(fetch_texel(texture, x, y) * scale);
        return std::isfinite(value) ? std::max(0.0, double(value)) : 0.0;
    };
    for (uint32_t x = 0; x < texture.width; ++x)
        filtered[x] = 0.125 * (brightness(x, above) + 6 * brightness(x, row) + brightness(x, below));
    for (uint32_t x = 0; x < texture.width; ++x) {
        const double left = filtered[(x + texture.width - 1) % texture.width];
        const double right = filtered[(x + 1) % texture.width];
        result[x] = 0.125 * (left + 6 * filtered[x] + right);
    }
    return result;
}

/// Part of texel `texel` of `texels` that lies in cell `cell` of `cells` along one axis; cells are not
/// narrower than texels.
double compute_overlap(uint64_t texel, uint64_t texels, uint64_t cell, uint64_t cells) {
    const uint64_t low = std::max(texel * cells, cell * texels);
    const uint64_t high = std::min((texel + 1) * cells, (cell + 1) * texels);
    return high > low ? double(high - low) / double(cells) : 0.0;
}

} // namespace

EnvironmentLight::EnvironmentLight(const Environment& environment)
    : environment_(environment), scale_(environment.color * environment.strength) {
    const double turn = environment.rotate_degrees * std::numbers::pi / 180;
    sin_turn_ = float(std::sin(turn)), cos_turn_ = float(std::cos(turn));
    if (environment_.texture)
        build_distribution();
    else
        mean_luminance_ = scalar::luminance(scale_);
}

void EnvironmentLight::build_distribution() {
    const Texture& texture = *environment_.texture;
    cells_x_ = std::min(texture.width, kMaxCellsX), cells_y_ = std::min(texture.height, kMaxCellsY);
    rows_.assign(cells_y_ + 1, 0.0f);
    columns_.assign(size_t(cells_y_) * (cells_x_ + 1), 0.0f);
    parallel_for("environment_rows", cells_y_, 1, [&](size_t begin, size_t end) {
        for (size_t cell_y = begin; cell_y < end; ++cell_y) {
            const std::span<float> cells = std::span(columns_).subspan(cell_y * (cells_x_ + 1), cells_x_ + 1);
            std::vector<double> sums(cells_x_, 0.0);
            const uint32_t first = uint32_t(cell_y * texture.height / cells_y_);
            const uint32_t last = uint32_t(((cell_y + 1) * texture.height + cells_y_ - 1) / cells_y_);
            for (uint32_t y = first; y < last; ++y) {
                const double sine_integral = std::cos(std::numbers::pi * y / texture.height) -
                                             std::cos(std::numbers::pi * (y + 1) / texture.height);
                const double share_y = sine_integral * compute_overlap(y, texture.height, cell_y, cells_y_);
                const std::vector<double> row = integrate_row(texture, y, scale_);
                for (uint32_t x = 0; x < texture.width; ++x) {
                    const uint32_t cell = uint32_t(uint64_t(x) * cells_x_ / texture.width);
                    const double share = compute_overlap(x, texture.width, cell, cells_x_);
                    sums[cell] += row[x] * share_y * share;
                    if (share < 1) sums[cell + 1] += row[x] * share_y * (1 - share);
                }
            }
            for (uint32_t x = 0; x < cells_x_; ++x) cells[x + 1] = float(sums[x]);
            rows_[cell_y + 1] = float(accumulate(cells));
        }
    });
    // The sine integrals sum up to 2 over the rows.
    mean_luminance_ = float(accumulate(rows_) / (2.0 * texture.width));
}

Vec3f EnvironmentLight::local_from_world(const Vec3f& d) const {
    return {d.x * cos_turn_ - d.z * sin_turn_, d.y, d.x * sin_turn_ + d.z * cos_turn_};
}

Vec3f EnvironmentLight::world_from_local(const Vec3f& d) const {
    return {d.x * cos_turn_ + d.z * sin_turn_, d.y, d.z * cos_turn_ - d.x * sin_turn_};
}

Vec3f EnvironmentLight::radiance(const Vec3f& direction) const {
    if (!environment_.texture) return scale_;
    return fetch_latlong(*environment_.texture, scalar::direction_to_latlong(local_from_world(direction))) *
           scale_;
}

/// Density per solid angle of a direction in a cell; 0 at the poles, which have no measure.
float EnvironmentLight::cell_density(uint32_t column, uint32_t row, const Vec3f& direction) const {
    const float* cells = columns_.data() + size_t(row) * (cells_x_ + 1);
    const float probability = (cells[column + 1] - cells[column]) * (rows_[row + 1] - rows_[row]);
    const float sine = std::sqrt(direction.x * direction.x + direction.z * direction.z);
    constexpr float kSquareOfUnitSine = 2 * std::numbers::pi_v<float> * std::numbers::pi_v<float>;
    return sine > 0 ? probability * float(cells_x_ * cells_y_) / (kSquareOfUnitSine * sine) : 0.0f;
}

EnvironmentLight::DirectionSample EnvironmentLight::draw_direction(const Vec2f& u) const {
    if (!environment_.texture) return {scalar::square_to_sphere(u), scalar::sphere_pdf()};
    const Interval row = find_interval(rows_, u.y);
    const size_t start = size_t(row.index) * (cells_x_ + 1);
    const Interval column = find_interval(std::span(columns_).subspan(start, cells_x_ + 1), u.x);
    const Vec2f position{(float(column.index) + column.position) / float(cells_x_),
                         (float(row.index) + row.position) / float(cells_y_)};
    const Vec3f direction = world_from_local(scalar::latlong_to_direction(position));
    return {direction, cell_density(column.index, row.index, direction), position};
}

Vec3f EnvironmentLight::radiance(const DirectionSample& drawn) const {
    return environment_.texture ? fetch_latlong(*environment_.texture, drawn.position) * scale_ : scale_;
}

EnvironmentLight::Lookup EnvironmentLight::look_up(const Vec3f& direction) const {
    if (!environment_.texture) return {scale_, scalar::sphere_pdf()};
    const Vec2f position = scalar::direction_to_latlong(local_from_world(direction));
    const uint32_t column = std::min(uint32_t(position.x * float(cells_x_)), cells_x_ - 1);
    const uint32_t row = std::min(uint32_t(position.y * float(cells_y_)), cells_y_ - 1);
    return {fetch_latlong(*environment_.texture, position) * scale_, cell_density(column, row, direction)};
}

} // namespace relief::cpu
