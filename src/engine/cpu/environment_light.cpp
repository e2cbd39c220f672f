#include "engine/cpu/environment_light.h"

#include <algorithm>
#include <array>
#include <span>

#include "engine/cpu/textures.h"

namespace relief::cpu {

namespace {

constexpr size_t kBlock = 32;    ///< directions that are drawn step by step together
constexpr uint32_t kGuides = 64; ///< a row of cells; a power of two

struct Interval {
    uint32_t index;
    float position; ///< within the interval, [0, 1)
};

/// Number of the interval of a cumulative distribution (0 ... 1) that u falls into, which lies in [first,
/// last]. Without branches: they would be taken at random.
uint32_t search_interval(std::span<const float> cumulative, float u, uint32_t first, uint32_t last) {
    for (uint32_t length = last - first; length > 0;) {
        const uint32_t half = (length + 1) / 2;
        first += cumulative[first + half] <= u ? half : 0;
        length -= half;
    }
    return first;
}

/// Writes where the search for u in [k, k + 1) / kGuides starts and ends: entries k and k + 1.
void fill_guide(std::span<const float> cumulative, std::span<uint16_t> guide) {
    const uint32_t last = uint32_t(cumulative.size()) - 2;
    for (uint32_t k = 0; k < kGuides; ++k)
        guide[k] = uint16_t(search_interval(cumulative, float(k) / float(kGuides), 0, last));
    guide[kGuides] = uint16_t(last);
}

uint32_t find_guide(float u) { return std::min(uint32_t(u * float(kGuides)), kGuides - 1); }

/// Interval that u falls into; never one of zero width.
Interval find_interval(std::span<const float> cumulative, const uint16_t* guide, float u) {
    const uint32_t k = find_guide(u);
    const uint32_t index = search_interval(cumulative, u, guide[k], guide[k + 1]);
    return {index, scalar::locate_in_interval(u, cumulative[index], cumulative[index + 1])};
}

} // namespace

EnvironmentLight::EnvironmentLight(const Environment& environment)
    : environment_(environment),
      distribution_(make_environment_distribution(environment)),
      data_(make_environment_data(environment, distribution_)) {
    if (!environment_.texture) return;
    const uint32_t rows = distribution_.cells_y;
    guides_.assign(size_t(rows + 1) * (kGuides + 1), uint16_t(0));
    for (uint32_t row = 0; row < rows; ++row)
        fill_guide(distribution_.row(row), std::span(guides_).subspan(row * (kGuides + 1), kGuides + 1));
    fill_guide(distribution_.rows, std::span(guides_).last(kGuides + 1));
}

Vec3f EnvironmentLight::radiance(const Vec2f& position) const {
    return environment_.texture ? fetch_latlong(*environment_.texture, position) * data_.scale : data_.scale;
}

/// Density per solid angle of a direction in a cell.
float EnvironmentLight::cell_density(uint32_t column, uint32_t row, const Vec3f& direction) const {
    const std::span<const float> cells = distribution_.row(row);
    const float probability =
        (cells[column + 1] - cells[column]) * (distribution_.rows[row + 1] - distribution_.rows[row]);
    return scalar::environment_cell_density(data_, probability, direction);
}

EnvironmentLight::DirectionSample EnvironmentLight::draw_direction(const Vec2f& u) const {
    DirectionSample drawn;
    draw_directions({&u, 1}, {&drawn, 1});
    return drawn;
}

void EnvironmentLight::draw_directions(std::span<const Vec2f> u, std::span<DirectionSample> drawn) const {
    if (!environment_.texture) {
        for (size_t k = 0; k < u.size(); ++k)
            drawn[k] = {scalar::square_to_sphere(u[k]), scalar::sphere_pdf()};
        return;
    }
    for (size_t first = 0; first < u.size(); first += kBlock) {
        const size_t count = std::min(kBlock, u.size() - first);
        draw_block(u.subspan(first, count), drawn.subspan(first, count));
    }
}

/// Each step has loaded for all directions what the next one reads.
void EnvironmentLight::draw_block(std::span<const Vec2f> u, std::span<DirectionSample> drawn) const {
    const auto guide = [this](uint32_t row) { return guides_.data() + size_t(row) * (kGuides + 1); };
    std::array<Interval, kBlock> rows;
    for (size_t k = 0; k < u.size(); ++k) {
        rows[k] = find_interval(distribution_.rows, guide(data_.cells_y), u[k].y);
        __builtin_prefetch(guide(rows[k].index) + find_guide(u[k].x));
    }
    for (size_t k = 0; k < u.size(); ++k)
        __builtin_prefetch(&distribution_.row(rows[k].index)[guide(rows[k].index)[find_guide(u[k].x)]]);
    for (size_t k = 0; k < u.size(); ++k) {
        const Interval& row = rows[k];
        const Interval column = find_interval(distribution_.row(row.index), guide(row.index), u[k].x);
        const Vec2f position{(float(column.index) + column.position) / float(data_.cells_x),
                             (float(row.index) + row.position) / float(data_.cells_y)};
        const Vec3f direction =
            scalar::turn_out_of_environment(data_, scalar::latlong_to_direction(position));
        drawn[k] = {direction, cell_density(column.index, row.index, direction), position};
    }
}

Vec2f EnvironmentLight::locate(const Vec3f& direction) const {
    return environment_.texture ? scalar::locate_in_environment(data_, direction) : Vec2f{};
}

void EnvironmentLight::prefetch_radiance(const Vec2f& position) const {
    if (environment_.texture) prefetch_latlong(*environment_.texture, position);
}

EnvironmentLight::Lookup EnvironmentLight::look_up(const Vec3f& direction, const Vec2f& position) const {
    if (!environment_.texture) return {data_.scale, scalar::sphere_pdf()};
    const uint32_t column = uint32_t(scalar::locate_environment_cell(position.x, float(data_.cells_x)));
    const uint32_t row = uint32_t(scalar::locate_environment_cell(position.y, float(data_.cells_y)));
    return {fetch_latlong(*environment_.texture, position) * data_.scale,
            cell_density(column, row, direction)};
}

size_t EnvironmentLight::byte_count() const {
    return (distribution_.rows.size() + distribution_.columns.size()) * sizeof(float) +
           guides_.size() * sizeof(uint16_t);
}

} // namespace relief::cpu
