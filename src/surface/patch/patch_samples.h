// One patch unpacked for evaluation: its corners, its edges' lines and the dominant vertices of its corners.
// The float operations here are the definition of the surface; the SIMD kernels repeat them bit for bit.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "formulas/levels.h"
#include "surface/patch/bicubic.h"
#include "surface/patch/surface.h"

namespace relief {

/// A vertex as its patch sees it, without a frame if not displaced through it. Four registers of four floats.
struct alignas(16) VertexData {
    Vec3f position{};
    Vec2f uv{};
    Frame frame{};
    TileIndex tile = 0;
    uint8_t mip = 0;
};

VertexData load_vertex(const Surface& surface, uint32_t vertex);

/// The sample's position moved by the displacement at its uv, through its frame where the map is tangent.
/// Where the tile has no map the displacement is (0, 0, 0) and takes the same way.
Vec3f displace(const DisplacementMap& map, const VertexData& sample);

/// Bilinear position, uv and frame (not renormalised) at (u, v) of corners 0..3.
VertexData blend_corners(const std::array<VertexData, 4>& corners, float u, float v);

/// Same on the line from `a` to `b` at `s`; tile and mip are those of `a`.
VertexData blend_line(const VertexData& a, const VertexData& b, float s);

/// Sample of an edge from its line's start, moved to the nearest of the edge's level (ties: later).
inline uint32_t move_edge_sample(uint32_t k, int patch_level, int edge_level) {
    return scalar::move_line_sample(k, uint32_t(patch_level - edge_level));
}

class PatchSamples {
  public:
    enum class Filtering { as_surface, none };
    PatchSamples(const Surface& surface, uint32_t patch, Filtering filtering = Filtering::as_surface);

    /// Displaced point of corner k, of its dominant vertex.
    Vec3f corner(int k) const;
    /// Displaced point on the line of edge k at s in (0, 1) from its start; the ends are corners.
    Vec3f edge(int k, float s) const;
    /// Displaced point inside.
    Vec3f interior(float u, float v) const;

    /// Corner that the line of edge k starts from, and the one that it ends at.
    int line_start(int k) const { return lines_[k].is_reversed ? (k + 1) & 3 : k; }
    int line_end(int k) const { return lines_[k].is_reversed ? k : (k + 1) & 3; }
    bool is_line_reversed(int k) const { return lines_[k].is_reversed; }
    /// True where edge k's line has other ends than the patch's corners or another copy of the map.
    bool is_line_foreign(int k) const { return lines_[k].is_foreign; }
    /// True where corner k is displaced by another vertex or another copy of the map.
    bool is_corner_foreign(int k) const { return is_corner_foreign_[k]; }

    /// Their frames hold the unit normal whether the map is tangent or not; zero on a surface without frames.
    const std::array<VertexData, 4>& corners() const { return corners_; }
    const VertexData& first_of_line(int k) const { return lines_[k].first; }
    const VertexData& second_of_line(int k) const { return lines_[k].second; }
    /// Inner control points of the line of edge k, from its start, where the base is bicubic.
    const std::array<Vec3f, 2>& line_controls(int k) const { return lines_[k].controls; }
    /// The bicubic base, or null.
    const BicubicBase* base() const { return base_ ? &*base_ : nullptr; }

  private:
    struct Line {
        VertexData first, second;
        std::array<Vec3f, 2> controls;
        bool is_reversed = false, is_foreign = false;
    };
    const DisplacementMap* map_;
    std::array<VertexData, 4> corners_, dominants_;
    std::array<Line, 4> lines_;
    std::array<bool, 4> is_corner_foreign_{};
    std::optional<BicubicBase> base_;
};

/// evaluate_vertex and compute_shading_normal (surface/patch/surface.h) of a patch that is unpacked already.
Vec3f evaluate_vertex(const PatchSamples& samples, const PatchLevels& levels, uint32_t i, uint32_t j);
Vec3f compute_shading_normal(const Surface& surface, const PatchSamples& samples, uint32_t patch, int level,
                             float u, float v);

/// Patches unpacked lately, for one thread: neighbouring rays hit the same few over and over.
class PatchSamplesCache {
  public:
    static constexpr uint32_t kDefaultSize = 32;
    /// `size`: places for patches, a power of two.
    explicit PatchSamplesCache(uint32_t size = kDefaultSize) : mask_(size - 1) {}
    /// Valid until the next call. The surface must outlive the cache.
    const PatchSamples& get(const Surface& surface, uint32_t patch);

  private:
    struct Entry {
        const Surface* surface = nullptr;
        uint32_t patch = 0;
        std::optional<PatchSamples> samples;
    };
    uint32_t mask_;
    std::vector<Entry> entries_; ///< none before the first use; a patch has one place only
};

} // namespace relief
