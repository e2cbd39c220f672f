// Quads of a refined mesh cut into smaller ones, in coordinates of the quad; shared sides are cut once.
#pragma once

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "surface/mesh/subdivision_mesh.h"

namespace relief {

/// An edge is cut at 1/2, 1/4, ... 2^-depth of its length from a point; densely also at 3/4, 3/8, ...
struct SideCut {
    uint32_t from = kNoIndex;
    int depth = 0;
    bool is_dense = false;

    int count() const { return is_dense ? 2 * depth : depth; }
    /// The cut after the one at `s`; the first is that after 1.
    double next(double s, int number) const {
        return !is_dense ? s / 2 : number % 2 == 0 ? s * 3 / 4 : s * 2 / 3;
    }
    friend bool operator==(const SideCut&, const SideCut&) = default;
};

/// A quad seen as the unit square: corner `turn` is (0, 0), the next one (1, 0), or (0, 1) where mirrored.
struct QuadView {
    uint32_t quad = 0, turn = 0;
    bool is_mirrored = false;
};

/// Makes another mesh quad by quad, in the order of the source.
class QuadCutter {
  public:
    using Corner = Vec2<double>;

    /// `cuts` holds one an edge of `source`.
    QuadCutter(const RefinedMesh& source, std::vector<SideCut> cuts);

    /// None of its sides is cut.
    void add_whole(uint32_t quad);

    /// All that follows is in this quad.
    void begin(const QuadView& view);
    /// Corners in order, counter-clockwise in the view. New corners inside become points.
    void add(const std::array<Corner, 4>& corners);
    void add_box(const Corner& lower, const Corner& upper);
    /// The edge between two corners of what has been added is no cubic.
    void bend(const Corner& a, const Corner& b);

    RefinedMesh finish();

  private:
    using Place = std::pair<double, double>;

    uint32_t add_point();
    uint32_t add_edge(bool is_sharp);
    uint32_t find_point(const Corner& corner);
    uint32_t find_edge(uint32_t a, uint32_t b);
    void register_side(uint32_t k);
    Corner blend_place(const Corner& corner) const;
    std::array<Vec2f, 4> blend_uvs(const std::array<Vec2f, 4>& uvs,
                                   const std::array<Corner, 4>& corners) const;
    void add_uvs(const std::array<Corner, 4>& corners);

    struct CutEdge {
        uint32_t point, edge; ///< the edge goes from the point away from where it is cut from
    };
    const RefinedMesh& source_;
    std::vector<SideCut> cuts_;
    RefinedMesh result_;
    std::vector<uint32_t> first_pieces_; ///< one an edge of the source: where its pieces begin, or kNoIndex
    std::vector<CutEdge> pieces_;
    QuadView view_;
    std::map<Place, uint32_t> points_;                        ///< of the quad at work, not mirrored
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> edges_; ///< by their points, the lower first
};

} // namespace relief
