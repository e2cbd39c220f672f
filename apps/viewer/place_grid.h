// Places of a surface over one tile of its map, on a grid of samples.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "base/udim.h"
#include "relief/scene.h"

namespace relief::viewer {

/// The part of the uv plane that a grid is over, and the end that its rows begin at.
struct GridPlace {
    bool has_tiles = false; ///< uvs outside of the square belong to other grids; otherwise the grid repeats
    UdimSquare square{};    ///< (0, 0) of a map without tiles
    bool flip_v = false;    ///< row 0 is at v = 0 of the square, not at v = 1
};

class PlaceGrid {
  public:
    /// width x height samples, none of which has a place.
    PlaceGrid(int width, int height);

    /// Gives the faces of a mesh to the samples whose middle they cover, or nearly do: a map is read a little
    /// beside faces, too. Where faces overlap in uv, the first one counts. The time is bounded by the number
    /// of samples and of corners, however far uvs reach and however often they overlap: faces for which no
    /// time is left have no samples.
    void draw(const Mesh& mesh, const GridPlace& place);

    /// `column`, `row`: in samples, from the corner of the grid. Bilinear where all four samples have places.
    std::optional<Vec3f> find(float column, float row) const;

    int width() const { return width_; }
    int height() const { return height_; }

  private:
    int width_, height_;
    std::vector<Vec3f> places_; ///< row by row; NaN: none
};

} // namespace relief::viewer
