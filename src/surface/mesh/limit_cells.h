// The limit surface of a smooth face beside extraordinary points: bicubic cells that become smaller towards
// them (Stam 1998, Exact evaluation of Catmull-Clark subdivision surfaces at arbitrary parameter values; here
// by subdivision of the points around the face).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "surface/mesh/spline_patch.h"

namespace relief {

/// A point of the mesh and those around it after a step of subdivision, counter-clockwise: the new points of
/// its edges, the first on the side of the face that begins at the point, and of its faces, the face itself
/// first.
struct PointFan {
    static constexpr size_t kMostEdges = 8;
    size_t count = 0;
    Vec3d point;
    std::array<Vec3d, kMostEdges> edges, faces;
};

/// The fans of part `part` of a polygon, which is a quad after a step, after one more step. `corners` are
/// those of the polygon's corners after one.
std::array<PointFan, 4> find_fans_of_part(const std::vector<PointFan>& corners, size_t part);

/// Evaluates the limit surface of one face. Cells are made when they are first needed, so that only one
/// thread at a time may evaluate a face.
class LimitCells {
  public:
    /// One fan per corner of the face; each has 3 edges or more.
    explicit LimitCells(const std::array<PointFan, 4>& corners);

    /// Evaluates the limit at (u, v) in [0, 1]^2 of the face.
    LimitSample evaluate(double u, double v, bool has_twist) const;
    Vec3d evaluate_position(double u, double v) const;

  private:
    using Grid = std::array<std::array<Vec3d, 5>, 5>; ///< points of two by two cells and around them
    /// Points around an irregular corner after some steps. The axes are the sides of the face from it.
    struct Ring {
        SplineControls around; ///< of the cell at the corner; (0, 0) has no meaning
        PointFan fan;
    };
    /// The three cells around the one at a corner: along the first side, across from it, along the other.
    using Level = std::array<SplineControls, 3>;
    struct Corner {
        LimitSample limit;         ///< at the corner, along its axes
        Ring ring;                 ///< after as many steps as there are levels, and one
        std::vector<Level> levels; ///< from cells of a quarter of the face on
    };
    struct Cell {
        const SplineControls* controls; ///< null: the innermost cell of `corner`
        double x, y;                    ///< place in it
        double scale;                   ///< of derivatives
        uint32_t turn;                  ///< corner whose sides are its axes
        const Corner* corner = nullptr;
    };
    Cell find_cell(double u, double v) const;
    static LimitSample evaluate_innermost(const Cell& cell);
    static LimitSample find_limit(const PointFan& fan);
    static Level subdivide(Ring& ring);

    std::array<SplineControls, 4> cells_;   ///< per corner; those at irregular ones have no meaning
    uint32_t irregular_corners_ = 0;        ///< bit k: corner k has not four edges
    mutable std::vector<Corner> irregular_; ///< the irregular ones, in order
    std::array<uint8_t, 4> places_{};       ///< per corner: its place among them
};

} // namespace relief
