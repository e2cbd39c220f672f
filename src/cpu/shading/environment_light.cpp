#include "cpu/shading/environment_light.h"

#include <algorithm>
#include <span>

#include "cpu/shading/shading_kernels.h"
#include "cpu/shading/textures.h"
#include "formulas/environment.h"
#include "formulas/warp.h"

namespace relief::cpu {

namespace {

constexpr uint32_t kGuides = EnvironmentTables::kGuides;

struct Bin {
    uint32_t index;
    float position; ///< within the interval, [0, 1)
};

/// Bin of a cumulative distribution (0 ... 1) that u falls into, in [first, last].
uint32_t search_interval(std::span<const float> cumulative, float u, uint32_t first, uint32_t last) {
    const auto begin = cumulative.begin() + first + 1, end = cumulative.begin() + last + 1;
    return first + uint32_t(std::upper_bound(begin, end, u) - begin);
}

/// Writes where the search for u in [k, k + 1) / kGuides starts and ends.
void fill_guide(std::span<const float> cumulative, std::span<uint32_t> guide) {
    const uint32_t last = uint32_t(cumulative.size()) - 2;
    uint32_t first = search_interval(cumulative, 0, 0, last);
    for (uint32_t k = 0; k < kGuides; ++k) {
        const uint32_t end =
            k + 1 < kGuides ? search_interval(cumulative, float(k + 1) / float(kGuides), 0, last) : last;
        guide[k] = first | end << 16;
        first = end;
    }
}

/// Bin that u falls into; never one of zero width.
Bin find_interval(std::span<const float> cumulative, const uint32_t* guides, float u) {
    const uint32_t guide = guides[std::min(uint32_t(u * float(kGuides)), kGuides - 1)];
    const uint32_t index = search_interval(cumulative, u, guide & 0xffff, guide >> 16);
    return {index, scalar::locate_in_interval(u, cumulative[index], cumulative[index + 1])};
}

} // namespace

EnvironmentLight::EnvironmentLight(const Environment& environment)
    : environment_(environment),
      distribution_(make_environment_distribution(environment)),
      data_(make_environment_data(environment, distribution_)) {
    if (!environment_.texture) return;
    const uint32_t rows = distribution_.cells_y;
    guides_.resize(size_t(rows + 1) * kGuides);
    for (uint32_t row = 0; row <= rows; ++row)
        fill_guide(row < rows ? distribution_.row(row) : std::span<const float>(distribution_.rows),
                   std::span(guides_).subspan(size_t(row) * kGuides, kGuides));
}

EnvironmentTables EnvironmentLight::tables() const {
    return {environment_.texture.get(), data_, distribution_.rows.data(), distribution_.columns.data(),
            guides_.data()};
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

EnvironmentLookup EnvironmentLight::look_up(const Vec3f& direction) const {
    if (!environment_.texture) return {data_.scale, scalar::sphere_pdf()};
    const Vec2f position = scalar::locate_in_environment(data_, direction);
    const uint32_t column = uint32_t(scalar::locate_environment_cell(position.x, float(data_.cells_x)));
    const uint32_t row = uint32_t(scalar::locate_environment_cell(position.y, float(data_.cells_y)));
    return {radiance(position), cell_density(column, row, direction)};
}

DirectionSample EnvironmentLight::draw_direction(const Vec2f& u) const {
    if (!environment_.texture) return {scalar::square_to_sphere(u), scalar::sphere_pdf()};
    const Bin row = find_interval(distribution_.rows, guides_.data() + size_t(data_.cells_y) * kGuides, u.y);
    const Bin column =
        find_interval(distribution_.row(row.index), guides_.data() + size_t(row.index) * kGuides, u.x);
    const Vec2f position{(float(column.index) + column.position) / float(data_.cells_x),
                         (float(row.index) + row.position) / float(data_.cells_y)};
    const Vec3f direction = scalar::turn_out_of_environment(data_, scalar::latlong_to_direction(position));
    return {direction, cell_density(column.index, row.index, direction), position};
}

void EnvironmentLight::look_up(const ShadingKernels& kernels, std::span<const Vec3f> directions,
                               std::span<EnvironmentLookup> found) const {
    if (environment_.texture)
        kernels.look_up_environment(tables(), directions.data(), directions.size(), found.data());
    else
        std::fill_n(found.begin(), directions.size(), EnvironmentLookup{data_.scale, scalar::sphere_pdf()});
}

void EnvironmentLight::fetch_radiance(const ShadingKernels& kernels, std::span<const Vec2f> positions,
                                      std::span<Vec3f> radiances) const {
    if (environment_.texture)
        kernels.fetch_environment(tables(), positions.data(), positions.size(), radiances.data());
    else
        std::fill_n(radiances.begin(), positions.size(), data_.scale);
}

void EnvironmentLight::draw_directions(const ShadingKernels& kernels, std::span<const Vec2f> u,
                                       std::span<DirectionSample> drawn) const {
    if (environment_.texture) return kernels.draw_directions(tables(), u.data(), u.size(), drawn.data());
    for (size_t k = 0; k < u.size(); ++k) drawn[k] = draw_direction(u[k]);
}

size_t EnvironmentLight::byte_count() const {
    return (distribution_.rows.size() + distribution_.columns.size()) * sizeof(float) +
           guides_.size() * sizeof(uint32_t);
}

} // namespace relief::cpu
