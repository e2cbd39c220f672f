// Vertices of a tile, sixteen at a time.
#pragma once

#include <optional>

#include "cpu/patch_trees/patch_tree.h"
#include "formulas/mips.h"
#include "surface/patch/patch_samples.h"
#include "surface/patch/sample_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// Vertices of a tile, row by row; rows are padded so that sixteen lanes can be stored anywhere.
struct VertexGrid {
    static constexpr int kPitch = (1 << cpu::kTileLevel) + 16;
    alignas(64) float axis[3][((1 << cpu::kTileLevel) + 1) * kPitch];
};

/// One tile of a patch: which cells, of which patch, at which levels.
struct TileRange {
    uint32_t patch;
    PatchLevels levels;
    uint32_t cell_x, cell_y, cell_count; ///< first cell and cells a side

    uint32_t side() const { return 1u << levels.patch; }
};

/// All rows and columns of the tile; those on a border of the patch are left to evaluate_border.
RELIEF_INLINE void evaluate_interior(const Surface& surface, const TileRange& range, VertexGrid& grid) {
    const MapImage image{surface.tile(surface.quads[range.patch].vertex[0]),
                         scalar::packed_mip(surface.packed_mips(range.patch), scalar::kMipInside)};
    const PatchValues patch(surface, range.patch);
    const Lanes16 inverse(1.0f / float(range.side()));
    const uint32_t n = range.cell_count;
    const uint32_t row_begin = range.cell_y == 0 ? 1 : 0;
    const uint32_t row_end = range.cell_y + n == range.side() ? n : n + 1;
    Lanes16 position[3];
    for (uint32_t c = 0; c < n; c += 16) {
        const Lanes16 u = make_ramp(float(range.cell_x + c)) * inverse;
        for (uint32_t r = row_begin; r < row_end; ++r) {
            evaluate_samples<Spacing::close>(surface, image, patch, u,
                                             Lanes16(float(range.cell_y + r)) * inverse, position);
            for (int axis = 0; axis < 3; ++axis)
                position[axis].store_unaligned(&grid.axis[axis][r * VertexGrid::kPitch + c]);
        }
    }
    if (n < 16 || range.cell_x + n == range.side()) return;
    // The last column by itself: a run of sixteen along each row would be for one sample.
    const Lanes16 u = Lanes16(float(range.cell_x + n)) * inverse;
    for (uint32_t r = row_begin; r < row_end; r += 16) {
        evaluate_samples<Spacing::close>(surface, image, patch, u,
                                         make_ramp(float(range.cell_y + r)) * inverse, position);
        alignas(64) float point[3][16];
        for (int axis = 0; axis < 3; ++axis) position[axis].store(point[axis]);
        for (uint32_t lane = 0; lane < 16 && r + lane < row_end; ++lane)
            for (int axis = 0; axis < 3; ++axis)
                grid.axis[axis][(r + lane) * VertexGrid::kPitch + n] = point[axis][lane];
    }
}

/// Samples of one border of the tile, on patch edge `edge`; `samples`: the patch, unpacked once.
RELIEF_INLINE void evaluate_border(const Surface& surface, const TileRange& range, int edge,
                                   std::optional<PatchSamples>& samples, VertexGrid& grid) {
    const uint32_t n = range.side(), step = n >> range.levels.edge[size_t(edge)];
    const Surface::EdgeLine line = surface.edge_line(range.patch, edge);
    const std::array<Vec3f, 2> controls = surface.line_controls(range.patch, edge, line);
    const uint32_t mip =
        scalar::packed_mip(surface.packed_mips(range.patch), scalar::kMipEdges + uint32_t(edge));
    const bool is_row = edge % 2 == 0;
    const bool is_far = edge == 1 || edge == 2;              // at u = 1 or v = 1
    const bool is_against = (edge >= 2) != line.is_reversed; // grid index runs against first -> second
    const uint32_t begin = is_row ? range.cell_x : range.cell_y;
    for (uint32_t c = 0; c <= range.cell_count; c += 16) {
        alignas(64) float s[16], point[3][16];
        bool is_corner[16], has_others = false;
        for (uint32_t lane = 0; lane < 16; ++lane) {
            const uint32_t index = begin + HWY_MIN(c + lane, range.cell_count);
            const uint32_t k = is_against ? n - index : index;
            const uint32_t moved = (k + step / 2) / step * step;
            is_corner[lane] = moved == 0 || moved == n;
            has_others |= !is_corner[lane];
            s[lane] = float(moved) * (1.0f / float(n));
        }
        if (has_others) {
            Lanes16 position[3];
            evaluate_line<Spacing::close>(surface, line, controls, mip, Lanes16::load(s), position);
            for (int axis = 0; axis < 3; ++axis) position[axis].store(point[axis]);
        }
        for (uint32_t lane = 0; lane < 16 && c + lane <= range.cell_count; ++lane) {
            const uint32_t along = c + lane, i = is_row ? along : is_far ? range.cell_count : 0;
            const uint32_t j = is_row ? (is_far ? range.cell_count : 0) : along;
            const uint32_t slot = j * VertexGrid::kPitch + i;
            if (is_corner[lane]) {
                if (!samples) samples.emplace(surface, range.patch);
                const Vec3f p = evaluate_vertex(*samples, range.levels, range.cell_x + i, range.cell_y + j);
                grid.axis[0][slot] = p.x, grid.axis[1][slot] = p.y, grid.axis[2][slot] = p.z;
            } else {
                for (int axis = 0; axis < 3; ++axis) grid.axis[axis][slot] = point[axis][lane];
            }
        }
    }
}

RELIEF_INLINE void evaluate_tile(const Surface& surface, const TileRange& range, VertexGrid& grid) {
    if (!can_evaluate_wide(surface, range.patch)) {
        for (uint32_t r = 0; r <= range.cell_count; ++r)
            for (uint32_t c = 0; c <= range.cell_count; ++c) {
                const Vec3f p =
                    evaluate_vertex(surface, range.patch, range.levels, range.cell_x + c, range.cell_y + r);
                const uint32_t slot = r * VertexGrid::kPitch + c;
                grid.axis[0][slot] = p.x, grid.axis[1][slot] = p.y, grid.axis[2][slot] = p.z;
            }
        return;
    }
    evaluate_interior(surface, range, grid);
    std::optional<PatchSamples> samples;
    const uint32_t n = range.side();
    if (range.cell_y == 0) evaluate_border(surface, range, 0, samples, grid);
    if (range.cell_x + range.cell_count == n) evaluate_border(surface, range, 1, samples, grid);
    if (range.cell_y + range.cell_count == n) evaluate_border(surface, range, 2, samples, grid);
    if (range.cell_x == 0) evaluate_border(surface, range, 3, samples, grid);
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
