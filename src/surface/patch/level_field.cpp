#include "surface/patch/level_field.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "formulas/levels.h"
#include "math/affine.h"
#include "math/vec_double.h"
#include "relief/render.h"
#include "surface/patch/level_lines.h"
#include "surface/patch/patch_samples.h"

namespace relief {

namespace {

constexpr double kSmoothCells = 8; // a texel, where the surface is curved between texels

/// What of a displaced line its level depends on, but for the view; `cells` as count_cells() finds them.
template <size_t N>
LineMeasure measure_line(const std::array<Vec3f, N>& line, double cells, const Affine& world_from_object) {
    LineMeasure measure;
    measure.cap = std::clamp(int(std::ceil(std::log2(std::max(cells, 1.0)))), 0, kMaxLevel);
    Box box;
    std::array<Vec3f, N> points;
    for (size_t k = 0; k < N; ++k) {
        points[k] = transform_point(world_from_object, line[k]);
        box.extend(points[k]);
        if (k > 0) measure.length += length(points[k] - points[k - 1]);
    }
    measure.center = box.center();
    for (const Vec3f& point : points)
        measure.radius = std::max(measure.radius, double(length(point - measure.center)));
    return measure;
}

int choose_level(const LineMeasure& line, const LevelFieldConfig& config) {
    const double distance = length(config.camera - line.center) - line.radius;
    if (!(line.length > 0)) return 0;
    const double cell = double(config.pixel_error) * config.pixel_angle * distance;
    // A camera among the points sees the line as near as can be.
    if (!(cell > 0)) return line.cap;
    return std::min(line.cap,
                    int(std::clamp(std::ceil(std::log2(line.length / cell)), 0.0, double(kMaxLevel))));
}

/// Cells that a line is worth: one a texel, or more where the filter is smooth; a bicubic base bends where
/// the map is smooth, too.
double count_cells(const Surface& surface, uint8_t tile, const Vec2f& a, const Vec2f& b) {
    const DisplacementMap& map = surface.map;
    const double least = surface.controls.empty() ? 0 : surface.most_base_cells;
    if (tile >= map.tiles.size()) return least;
    const Texture& texture = *map.tiles[tile].texture;
    const double texels =
        compute_length((double(b.x) - a.x) * texture.width, (double(b.y) - a.y) * texture.height);
    return std::max(least, map.is_smooth ? kSmoothCells * texels : texels);
}

/// Of the edges, and of lines through the middle: the map may stretch the inside more than the edges.
PatchLines measure_patch(const Surface& surface, uint32_t patch, const Affine& world_from_object) {
    const PatchSamples samples(surface, patch, PatchSamples::Filtering::none);
    const LevelLines lines = evaluate_level_lines(surface, patch, samples);
    PatchLines measures;
    for (size_t direction = 0; direction < 2; ++direction) {
        const auto blend = [&](float s) {
            return direction == 0 ? blend_corners(samples.corners(), s, 0.5f)
                                  : blend_corners(samples.corners(), 0.5f, s);
        };
        const VertexData a = blend(0), b = blend(1);
        measures.middles[direction] = measure_line(
            lines.middles[direction], count_cells(surface, a.tile, a.uv, b.uv), world_from_object);
    }
    for (int edge = 0; edge < 4; ++edge) {
        const VertexData &first = samples.first_of_line(edge), &second = samples.second_of_line(edge);
        measures.edges[size_t(edge)] =
            measure_line(lines.edges[size_t(edge)], count_cells(surface, first.tile, first.uv, second.uv),
                         world_from_object);
    }
    return measures;
}

PatchLevels choose_levels(const PatchLines& lines, const LevelFieldConfig& config) {
    PatchLevels levels{};
    for (const LineMeasure& line : lines.middles)
        levels.patch = std::max(levels.patch, uint8_t(choose_level(line, config)));
    for (size_t edge = 0; edge < 4; ++edge) {
        levels.edge[edge] = uint8_t(choose_level(lines.edges[edge], config));
        levels.patch = std::max(levels.patch, levels.edge[edge]);
    }
    return levels;
}

} // namespace

std::vector<PatchLines> measure_lines(const Surface& surface, const Affine& world_from_object) {
    std::vector<PatchLines> lines(surface.has_displacement ? surface.patch_count() : 0);
    parallel_for("measure lines", lines.size(), 64, [&](size_t begin, size_t end) {
        for (size_t patch = begin; patch < end; ++patch)
            lines[patch] = measure_patch(surface, uint32_t(patch), world_from_object);
    });
    return lines;
}

template <class Find>
LevelField LevelField::fill(const Surface& surface, const LevelFieldConfig& config, const Find& find_levels) {
    LevelField field;
    if (!surface.has_displacement) return field;
    if (config.fixed_level >= 0) {
        field.max_level_ = std::min(config.fixed_level, kMaxLevel);
        field.fixed_ = scalar::pack_uniform_level(uint32_t(field.max_level_));
        return field;
    }
    field.packed_.resize(surface.patch_count());
    parallel_for("level field", field.packed_.size(), 256, [&](size_t begin, size_t end) {
        for (size_t patch = begin; patch < end; ++patch)
            field.packed_[patch] = pack_levels(find_levels(uint32_t(patch)));
    });
    field.find_max_level();
    return field;
}

LevelField LevelField::compute(const Surface& surface, const Affine& world_from_object,
                               const LevelFieldConfig& config) {
    return fill(surface, config, [&](uint32_t patch) {
        return choose_levels(measure_patch(surface, patch, world_from_object), config);
    });
}

LevelField LevelField::choose(const Surface& surface, std::span<const PatchLines> lines,
                              const LevelFieldConfig& config) {
    return fill(surface, config, [&](uint32_t patch) { return choose_levels(lines[patch], config); });
}

void LevelField::update(const Surface& surface, const Affine& world_from_object,
                        const LevelFieldConfig& config, std::span<const uint8_t> is_changed) {
    if (packed_.empty()) return;
    parallel_for("level field of an edit", packed_.size(), 256, [&](size_t begin, size_t end) {
        for (size_t patch = begin; patch < end; ++patch)
            if (is_changed[patch])
                packed_[patch] = pack_levels(
                    choose_levels(measure_patch(surface, uint32_t(patch), world_from_object), config));
    });
    find_max_level();
}

void LevelField::find_max_level() {
    max_level_ = 0;
    for (const uint32_t levels : packed_)
        max_level_ = std::max(max_level_, int(scalar::packed_patch_level(levels)));
}

} // namespace relief
