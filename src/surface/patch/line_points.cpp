#include "surface/patch/line_points.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "math/affine.h"
#include "math/box.h"
#include "math/vec_double.h"
#include "relief/render.h"
#include "surface/patch/patch_samples.h"

namespace relief {

namespace {

constexpr double kSmoothCells = 8; // a texel, where the surface is curved between texels

/// Cells that a line is worth: one a texel, or more where the filter is smooth; a bicubic base bends where
/// the map is smooth, too.
double count_cells(const Surface& surface, TileIndex tile, const Vec2f& a, const Vec2f& b) {
    const DisplacementMap& map = surface.map;
    const double least = surface.controls.empty() ? 0 : surface.most_base_cells;
    if (tile >= map.tiles.size()) return least;
    const Texture& texture = *map.tiles[tile].texture;
    const double texels =
        compute_length((double(b.x) - a.x) * texture.width, (double(b.y) - a.y) * texture.height);
    return std::max(least, map.is_smooth ? kSmoothCells * texels : texels);
}

uint8_t find_cap(double cells) {
    return uint8_t(std::clamp(int(std::ceil(std::log2(std::max(cells, 1.0)))), 0, kMaxLevel));
}

/// Measures of four lines. All loops go over arrays of four numbers or a multiple, which compilers make lanes
/// of.
template <size_t Count> class FourMeasures {
  public:
    FourMeasures(const FourLines<Count>& lines, const Affine& world_from_object) {
        move(lines, world_from_object);
        find_lengths();
        find_spheres();
    }

    LineMeasure get(size_t line, uint8_t cap) const {
        return {length_[line],
                double(std::sqrt(farthest_[line])),
                {center_x_[line], center_y_[line], center_z_[line]},
                cap};
    }

  private:
    void move(const FourLines<Count>& lines, const Affine& world_from_object) {
        const auto& [row_x, row_y, row_z] = world_from_object.rows;
        const Vec3f& translation = world_from_object.translation;
        for (size_t k = 0; k < 4 * Count; ++k) {
            const float x = lines.x[k], y = lines.y[k], z = lines.z[k];
            x_[k] = row_x.x * x + row_x.y * y + row_x.z * z + translation.x;
            y_[k] = row_y.x * x + row_y.y * y + row_y.z * z + translation.y;
            z_[k] = row_z.x * x + row_z.y * y + row_z.z * z + translation.z;
        }
    }

    void find_lengths() {
        std::array<float, 4 * Count> steps;
        for (size_t k = 0; k < 4 * (Count - 1); ++k) {
            const float x = x_[k + 4] - x_[k], y = y_[k + 4] - y_[k], z = z_[k + 4] - z_[k];
            steps[k] = std::sqrt(x * x + y * y + z * z);
        }
        for (size_t k = 0; k < 4 * (Count - 1); k += 4)
            for (size_t line = 0; line < 4; ++line) length_[line] += double(steps[k + line]);
    }

    static void find_center(const std::array<float, 4 * Count>& values, std::array<float, 4>& center) {
        std::array<float, 4> lower, upper;
        for (size_t line = 0; line < 4; ++line) lower[line] = upper[line] = values[line];
        for (size_t k = 4; k < 4 * Count; k += 4)
            for (size_t line = 0; line < 4; ++line) {
                lower[line] = std::min(lower[line], values[k + line]);
                upper[line] = std::max(upper[line], values[k + line]);
            }
        for (size_t line = 0; line < 4; ++line) center[line] = (lower[line] + upper[line]) * 0.5f;
    }

    void find_spheres() {
        find_center(x_, center_x_), find_center(y_, center_y_), find_center(z_, center_z_);
        for (size_t k = 0; k < 4 * Count; k += 4)
            for (size_t line = 0; line < 4; ++line) {
                const float x = x_[k + line] - center_x_[line], y = y_[k + line] - center_y_[line],
                            z = z_[k + line] - center_z_[line];
                farthest_[line] = std::max(farthest_[line], x * x + y * y + z * z);
            }
    }

    std::array<float, 4 * Count> x_, y_, z_;
    std::array<float, 4> center_x_, center_y_, center_z_, farthest_{};
    std::array<double, 4> length_{};
};

template <size_t Count>
void store_line(const std::array<Vec3f, Count>& points, size_t line, FourLines<Count>& lines) {
    for (size_t k = 0; k < Count; ++k) {
        const size_t place = 4 * k + line;
        lines.x[place] = points[k].x, lines.y[place] = points[k].y, lines.z[place] = points[k].z;
    }
}

} // namespace

/// Measures the edges and lines through the middle of a patch: the map may stretch the inside more than the
/// edges.
LinePoints make_line_points(const Surface& surface, uint32_t patch) {
    const PatchSamples samples(surface, patch, PatchSamples::Filtering::none);
    const LevelLines lines = evaluate_level_lines(surface, patch, samples);
    LinePoints points;
    for (size_t edge = 0; edge < 4; ++edge) {
        store_line(lines.edges[edge], edge, points.edges);
        const VertexData &first = samples.first_of_line(int(edge)),
                         &second = samples.second_of_line(int(edge));
        points.edge_caps[edge] = find_cap(count_cells(surface, first.tile, first.uv, second.uv));
    }
    for (size_t direction = 0; direction < 2; ++direction) {
        store_line(lines.middles[direction], direction, points.middles);
        const auto blend = [&](float s) {
            return direction == 0 ? blend_corners(samples.corners(), s, 0.5f)
                                  : blend_corners(samples.corners(), 0.5f, s);
        };
        const VertexData a = blend(0), b = blend(1);
        points.middle_caps[direction] = find_cap(count_cells(surface, a.tile, a.uv, b.uv));
    }
    return points;
}

std::vector<LinePoints> list_line_points(const Surface& surface) {
    std::vector<LinePoints> points(surface.has_displacement ? surface.patch_count() : 0);
    parallel_for("lines of levels", points.size(), 64, [&](size_t begin, size_t end) {
        for (size_t patch = begin; patch < end; ++patch)
            points[patch] = make_line_points(surface, uint32_t(patch));
    });
    return points;
}

PatchLines measure_line_points(const LinePoints& points, const Affine& world_from_object) {
    const FourMeasures edges(points.edges, world_from_object);
    const FourMeasures middles(points.middles, world_from_object);
    PatchLines lines;
    for (size_t k = 0; k < 4; ++k) lines.edges[k] = edges.get(k, points.edge_caps[k]);
    for (size_t k = 0; k < 2; ++k) lines.middles[k] = middles.get(k, points.middle_caps[k]);
    return lines;
}

} // namespace relief
