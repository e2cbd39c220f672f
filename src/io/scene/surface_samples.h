// Points of displaced surfaces, near enough to frame a picture with.
#pragma once

#include <cstddef>
#include <vector>

#include "relief/scene.h"

namespace relief {

/// Points spread evenly over the faces of a mesh and displaced by the nearest texels, in the space of the
/// object. Refers to the mesh and the map. Several threads may ask for rows at once.
class DisplacedSamples {
  public:
    /// Makes about `count` samples, and at least one per face. Displacements of world space are turned into
    /// the object's by `object_from_world`.
    DisplacedSamples(const Mesh& mesh, const Displacement& map, const Affine& object_from_world,
                     double count);

    /// Each face has the same number of rows.
    size_t row_count() const { return starts_.size() * size_t(steps_); }
    /// Appends the samples of one row to `points`. Throws relief::Error where the map displaces too far.
    void append_row(size_t row, std::vector<Vec3f>& points) const;

  private:
    const Mesh& mesh_;
    const Displacement& map_;
    const Affine object_from_world_;
    const int steps_;            ///< rows per face, and samples per row
    std::vector<size_t> starts_; ///< first corners of faces
};

/// Twice the sum of the area vectors of all faces.
Vec3f sum_area_vectors(const Mesh& mesh);

} // namespace relief
