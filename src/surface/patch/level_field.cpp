#include "surface/patch/level_field.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "formulas/levels.h"
#include "math/affine.h"
#include "relief/render.h"

namespace relief {

namespace {

/// The least k such that `ratio` <= 2^k, in [0, kMaxLevel]; a ratio may exceed its power of two by rounding.
int round_up_to_level(double ratio) {
    if (!(ratio < double(1 << kMaxLevel))) return kMaxLevel;
    int exponent = 0;
    std::frexp(ratio * (1 - 0x1p-50), &exponent);
    return std::max(exponent, 0);
}

uint8_t choose_level(const LineMeasure& line, const LevelFieldConfig& config) {
    const double distance = length(config.camera - line.center) - line.radius;
    if (!(line.length > 0)) return 0;
    const double cell = double(config.pixel_error) * config.pixel_angle * distance;
    // A camera among the points sees the line as near as can be.
    const int level = cell > 0 ? round_up_to_level(line.length / cell) : kMaxLevel;
    return uint8_t(std::min(level, int(line.cap)));
}

PatchLevels choose_levels(const PatchLines& lines, const LevelFieldConfig& config) {
    PatchLevels levels;
    for (const LineMeasure& line : lines.middles)
        levels.patch = std::max(levels.patch, choose_level(line, config));
    for (size_t edge = 0; edge < 4; ++edge) {
        levels.edge[edge] = choose_level(lines.edges[edge], config);
        levels.patch = std::max(levels.patch, levels.edge[edge]);
    }
    return levels;
}

PatchLines measure_patch(const Surface& surface, uint32_t patch, const Affine& world_from_object) {
    return measure_line_points(make_line_points(surface, patch), world_from_object);
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
LevelField LevelField::fill(const Surface& surface, const LevelFieldConfig& config, const Find& find_lines) {
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
            field.packed_[patch] = pack_levels(choose_levels(find_lines(uint32_t(patch)), config));
    });
    field.find_max_level();
    return field;
}

LevelField LevelField::compute(const Surface& surface, const Affine& world_from_object,
                               const LevelFieldConfig& config) {
    return fill(surface, config,
                [&](uint32_t patch) { return measure_patch(surface, patch, world_from_object); });
}

LevelField LevelField::compute(const Surface& surface, std::span<const LinePoints> points,
                               const Affine& world_from_object, const LevelFieldConfig& config) {
    return fill(surface, config,
                [&](uint32_t patch) { return measure_line_points(points[patch], world_from_object); });
}

LevelField LevelField::choose(const Surface& surface, std::span<const PatchLines> lines,
                              const LevelFieldConfig& config) {
    return fill(surface, config, [&](uint32_t patch) { return lines[patch]; });
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
