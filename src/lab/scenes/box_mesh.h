// Closed meshes of quads around boxes on a lattice, whose sides are charts of uvs: the cages of the
// characters that measurements use.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "relief/scene.h"

namespace relief {

using LatticePoint = std::array<int, 3>;

/// Boxes may touch by whole faces of lattice cells, and do not overlap.
struct LatticeBox {
    LatticePoint low, high;
    int axis = 1; ///< sides 0 to 3 go around it, counter-clockwise as seen from its high end
};

/// Four sides around the axis, then the ends at its low and at its high lattice coordinate.
inline constexpr int kBoxSides = 6, kLowEnd = 4, kHighEnd = 5;

struct UvRectangle {
    Vec2f low, size;
};

/// One side of a box: a grid of quads, row by row, and its rectangle on the uv plane.
struct BoxSide {
    int across = 0, along = 0; ///< quads
    UvRectangle uv;
    std::vector<uint32_t>
        points; ///< (across + 1) x (along + 1) positions; kNoIndex: inside what another box covers
};

struct BoxMesh {
    Mesh mesh;                         ///< positions are lattice coordinates until the caller shapes them
    std::vector<LatticePoint> lattice; ///< of each position, times the cells of a step
    std::vector<BoxSide> sides;        ///< kBoxSides of each box
};

/// Lattice steps of a side of a box: across, along.
std::array<int, 2> find_side_size(const LatticeBox& box, int side);

/// The quads of all sides, without the parts that other boxes cover, facing outwards; `cells`: quads for each
/// lattice step. `place` returns the uv rectangle of a side of a box. Sides whose rectangles share an edge
/// share its uvs.
BoxMesh make_box_mesh(const std::vector<LatticeBox>& boxes, int cells,
                      const std::function<UvRectangle(size_t box, int side)>& place);

/// Moves each position towards the mean of its neighbours, `rounds` times: rounds the boxes off.
void smooth_positions(Mesh& mesh, int rounds);

/// Creases along all edges between two lattice points whose coordinate `axis` is `value`, in cells.
void add_crease_loop(BoxMesh& body, int axis, int value, float sharpness);

struct SurfacePoint {
    Vec3f position, normal; ///< the normal has unit length, or is 0 where the mesh has no face
};

/// Looks up points of the shaped mesh by uv. Between and beside the sides, the nearest one counts.
class SurfaceFinder {
  public:
    /// Keeps a reference to `body`.
    explicit SurfaceFinder(const BoxMesh& body);
    SurfacePoint find(const Vec2f& uv) const;

  private:
    const BoxMesh& body_;
    std::vector<Vec3f> normals_; ///< of each position
};

} // namespace relief
