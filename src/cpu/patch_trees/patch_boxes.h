// Boxes of displaced patches: from the bounds of their maps before the first ray, or from the vertices, with
// a quarter to a third less area, which takes as long as building what is inside.
#pragma once

#include <cstdint>
#include <vector>

#include "cpu/traversal/kernels.h"

namespace relief::cpu {

enum class BoxSource { bounds, vertices };

class PatchBoxes {
  public:
    /// `scene` and `kernels` outlive this.
    PatchBoxes(const PreparedScene& scene, const Kernels& kernels, BoxSource source);

    /// Holds a patch of a displaced surface in all its instances, for any bias.
    Box find(uint32_t surface, uint32_t patch) const;

    /// Those of all patches of a displaced surface, in parallel.
    std::vector<Box> find_all(uint32_t surface) const;

    /// Vertices that find() evaluates for the patches of all surfaces; of large surfaces by samples.
    uint64_t count_vertices() const;

  private:
    uint32_t find_level(uint32_t surface, uint32_t patch) const;

    const PreparedScene& scene_;
    const Kernels& kernels_;
    BoxSource source_;
    std::vector<std::vector<const LevelField*>> fields_; ///< of the instances of each surface
};

} // namespace relief::cpu
