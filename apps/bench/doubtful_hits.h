// Hits that two trees may disagree on. Rounding lets the test of a triangle find one whose box the ray misses
// by a few units in the last place; whether a walk comes to it depends on the boxes around it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lab/trees.h"
#include "relief/scene.h"

namespace relief::bench {

class DoubtfulHits {
  public:
    /// The mesh has to live as long.
    explicit DoubtfulHits(const Mesh& mesh);

    /// Whether the ray misses the box of the triangle that it hit, in double precision.
    bool is_doubtful(const Ray& ray, const TreeHit& hit) const;

  private:
    const Mesh& mesh_;
    std::vector<std::array<uint32_t, 3>> triangles_; ///< corners, faces cut into fans in their order
};

} // namespace relief::bench
