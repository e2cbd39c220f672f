// Hits on which two trees may disagree: by rounding, a ray may hit a triangle whose box it misses by a few
// ulp; whether a traversal reaches the triangle depends on the enclosing boxes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lab/trees.h"
#include "relief/scene.h"

namespace relief::bench {

class DoubtfulHits {
  public:
    /// The mesh must outlive this object.
    explicit DoubtfulHits(const Mesh& mesh);

    /// Whether the ray misses the box of the triangle that it hit, in double precision.
    bool is_doubtful(const Ray& ray, const TreeHit& hit) const;

  private:
    const Mesh& mesh_;
    std::vector<std::array<uint32_t, 3>> triangles_; ///< corners; faces as triangle fans in order
};

} // namespace relief::bench
