#include "surface/mesh/edge_splits.h"

#include <array>
#include <vector>

#include "base/check.h"
#include "relief/scene.h"

namespace relief {

namespace {

/// Joins quads with an odd number of split edges. The number of such quads that can reach each other across
/// edges which are not split is even, or they can reach a boundary, so that every search ends.
class OddQuads {
  public:
    OddQuads(const Cage& cage, std::vector<uint8_t>& is_split)
        : cage_(cage),
          is_split_(is_split),
          faces_of_edge_(is_split.size(), {kNoIndex, kNoIndex}),
          is_odd_(cage.face_count()),
          seen_by_(cage.face_count(), kNoIndex),
          came_by_(cage.face_count(), kNoIndex) {
        for (uint32_t face = 0; face < cage.face_count(); ++face)
            for (uint32_t corner = cage.starts[face]; corner < cage.starts[face + 1]; ++corner) {
                std::array<uint32_t, 2>& faces = faces_of_edge_[cage.edges[corner]];
                faces[faces[0] == kNoIndex ? 0 : 1] = face;
                if (cage.face_size(face) == 4 && is_split[cage.edges[corner]]) is_odd_[face] ^= 1;
            }
    }

    void join() {
        for (uint32_t face = 0; face < cage_.face_count(); ++face)
            if (is_odd_[face]) join_to_nearest(face);
    }

  private:
    /// Searches from face to face, breadth first.
    void join_to_nearest(uint32_t start) {
        pending_.assign(1, start);
        seen_by_[start] = start, came_by_[start] = kNoIndex;
        for (size_t next = 0; next < pending_.size(); ++next) {
            const uint32_t face = pending_[next];
            for (uint32_t corner = cage_.starts[face]; corner < cage_.starts[face + 1]; ++corner) {
                const uint32_t edge = cage_.edges[corner];
                if (is_split_[edge]) continue;
                const uint32_t other = find_other(edge, face);
                if (other == kNoIndex) { // a boundary takes any split
                    is_split_[edge] = 1;
                    return split_way(start, face);
                }
                if (seen_by_[other] == start) continue;
                seen_by_[other] = start, came_by_[other] = edge;
                if (is_odd_[other]) {
                    is_odd_[other] = 0;
                    return split_way(start, other);
                }
                pending_.push_back(other);
            }
        }
        DCHECK(false);
    }

    uint32_t find_other(uint32_t edge, uint32_t face) const {
        const std::array<uint32_t, 2>& faces = faces_of_edge_[edge];
        return faces[0] == face ? faces[1] : faces[0];
    }

    /// Splits the edges on the way from `face` back to `start`.
    void split_way(uint32_t start, uint32_t face) {
        is_odd_[start] = 0;
        while (face != start) {
            const uint32_t edge = came_by_[face];
            is_split_[edge] = 1;
            face = find_other(edge, face);
        }
    }

    const Cage& cage_;
    std::vector<uint8_t>& is_split_;
    std::vector<std::array<uint32_t, 2>> faces_of_edge_;
    std::vector<uint8_t> is_odd_;
    std::vector<uint32_t> pending_; ///< faces of the search, in order
    std::vector<uint32_t> seen_by_,
        came_by_; ///< the last search that saw a face, and the edge it came across
};

} // namespace

void make_splits_even(const Cage& cage, std::vector<uint8_t>& is_split) {
    for (uint32_t face = 0; face < cage.face_count(); ++face)
        if (cage.face_size(face) != 4)
            for (uint32_t corner = cage.starts[face]; corner < cage.starts[face + 1]; ++corner)
                is_split[cage.edges[corner]] = 1;
    OddQuads(cage, is_split).join();
}

} // namespace relief
