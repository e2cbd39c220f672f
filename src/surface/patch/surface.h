// A mesh with its displacement, made ready to be evaluated: compact patches, seams resolved, frames packed.
//
// Vertices are split where uvs or frame sources differ; those of one point share its position and know their
// dominant one, the lowest; dominant vertices come first. Patches have corners 0..3 counter-clockwise at (u,
// v) = (0,0) (1,0) (1,1) (0,1); edge k runs from corner k to (k + 1) mod 4.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "formulas/control_points.h"
#include "formulas/levels.h"
#include "math/box.h"
#include "relief/scene.h"
#include "surface/map/bounds_pyramid.h"
#include "surface/map/tile_index.h"
#include "surface/mesh/base_tolerance.h"
#include "surface/mesh/quad_list.h"
#include "surface/patch/edge_overrides.h"

namespace relief {

/// Unit normal and tangent of a vertex, octahedral, 2 x 16 bits; bit 0 of `tangent`: bitangent -cross(N, T).
struct PackedFrame {
    uint32_t normal = 0, tangent = 0;
};

/// Frame of a vertex: orthonormal, but with relative lengths t and b are dP/du and dP/dv.
struct Frame {
    Vec3f t, b, n;
};

PackedFrame pack_frame(const Vec3f& normal, const Vec3f& tangent, float handedness);
Frame unpack_frame(const PackedFrame& packed);
/// The normal of unpack_frame alone.
Vec3f unpack_normal(const PackedFrame& packed);

class MipChain;

/// Tiles to the left, to the right, above and below in the image; Surface::kNoTile where there is none.
using TileNeighbours = std::array<TileIndex, 4>;

/// Displacement of raw texel values: matrix (value - midlevel), in (t, b, n) or object (x, y, z).
struct DisplacementMap {
    struct Tile {
        int udim = 1001;
        std::shared_ptr<const Texture> texture;
        std::shared_ptr<const BoundsPyramid> pyramid;
        std::shared_ptr<const MipChain> mips; ///< null: the map is not filtered
    };
    /// An image of the map.
    struct ImageView {
        const Texture& texture;
        const BoundsPyramid& pyramid;
    };
    std::vector<Tile> tiles;
    /// Per tile of a map with UDIM tiles, else empty: where a mesh goes on beyond it
    /// (surface/map/tile_texels.h).
    std::vector<TileNeighbours> neighbours;
    std::vector<std::pair<int, TileIndex>> udims; ///< number and index of each tile, sorted
    std::array<Vec3f, 3> matrix; ///< rows; signed permutation, scale and (world space) the object's inverse
    Vec3f midlevel{};
    WrapMode wrap = WrapMode::clamp;
    bool flip_v = false;
    bool is_tangent = false; ///< d is (t, b, n) and goes through the frame
    float longest_axis = 1;  ///< no coordinate of a frame's axes is larger
    bool is_filtered = false, has_autobump = false;
    bool is_smooth = false; ///< texels are coefficients of a uniform bicubic B-spline; no mips

    /// Index of a tile by its number; Surface::kNoTile where there is none.
    TileIndex find_tile(int udim) const;
    /// Copy `mip` of a tile that exists; 0 is the tile's own image.
    ImageView image(TileIndex tile, uint32_t mip) const;
};

/// Control points of a bicubic patch beside its corners (less 4), bit-equal on shared edges.
using InnerControls = std::array<Vec3f, scalar::kInnerControlCount>;

/// Uvs for textures of materials: of another set than the mesh's own, or its own (kOwnUvSet) with the offsets
/// of tiles, which Surface::uvs lack.
struct PatchUvs {
    int number = 0;                            ///< as UvSet::number
    std::vector<std::array<Vec2f, 4>> corners; ///< one a patch; of a triangle the last two are alike
};

/// Read from any thread. Only the texels and bounds behind `map`, and `mips`, ever change, through the
/// scene's editor (prepare/scene_edit.h) and while nobody reads.
struct Surface {
    std::string name;                ///< of the mesh, for messages
    std::vector<Vec3f> positions;    ///< one a dominant vertex; the others have theirs
    NarrowIndices<1> copies;         ///< the dominant vertex of vertex positions.size() + k
    std::vector<Vec2f> uvs;          ///< one a split vertex, or empty; tile offset taken off when displaced
    std::vector<PackedFrame> frames; ///< one a split vertex, or empty: facets (undisplaced, no normals)
    std::vector<std::array<Vec3f, 2>> derivatives; ///< dP/du, dP/dv; one a split vertex where lengths are
                                                   ///< relative, or empty
    /// Of normal maps, one a corner of each patch as in PackedFrame::tangent, or empty: no material has one.
    std::vector<std::array<uint32_t, 4>> corner_tangents;
    std::vector<PatchUvs> further_uvs;
    std::vector<TileIndex> vertex_tiles; ///< index into map.tiles, kNoTile: displaced by 0; empty: all tile 0
    QuadList quads;
    std::vector<InnerControls> controls; ///< one a patch: its base is bicubic; empty: bilinear
    /// Per dominant vertex, or empty: how far the smooth surface that the normals of a face stand for lies
    /// above it along that face's normal, of vertices inside faces that were cut into several patches.
    std::vector<float> base_heights;
    int most_base_cells = 32;   ///< per side, that a bicubic patch may have for the sake of its base alone
    std::vector<uint32_t> mips; ///< one a patch (formulas/mips.h), or empty: the map itself everywhere
    BaseReserve base_reserve;   ///< for which other tolerances the patches would be the same
    EdgeOverrides overrides;    ///< edges whose samples come from the other side of a uv seam
    DisplacementMap map;        ///< no tiles: undisplaced
    bool has_displacement = false;
    /// Uvs of polygons are bilinear, as in the patches that they were cut from; else linear on each triangle.
    bool has_bilinear_uvs = false;

    static constexpr TileIndex kNoTile = 0xffff;
    static_assert(kMaxMapTiles < kNoTile);

    uint32_t patch_count() const { return uint32_t(quads.size()); }
    uint32_t vertex_count() const { return uint32_t(positions.size() + copies.size()); }
    uint32_t dominant(uint32_t vertex) const {
        return vertex < positions.size() ? vertex : copies[vertex - positions.size()][0];
    }
    const Vec3f& position(uint32_t vertex) const { return positions[dominant(vertex)]; }
    uint32_t packed_mips(uint32_t patch) const { return mips.empty() ? 0 : mips[patch]; }
    /// What a vertex is displaced through; `frames` must not be empty.
    Frame frame(uint32_t vertex) const {
        if (derivatives.empty()) return unpack_frame(frames[vertex]);
        return {derivatives[vertex][0], derivatives[vertex][1], unpack_normal(frames[vertex])};
    }
    /// What a texture on the set of a number is read at; null: `uvs`, for the mesh's own set, whatever it is
    /// called.
    const PatchUvs* find_further_uvs(int number) const {
        const PatchUvs* own = nullptr;
        for (const PatchUvs& set : further_uvs) {
            if (set.number == number) return &set;
            if (set.number == kOwnUvSet) own = &set;
        }
        return own;
    }
    TileIndex tile(uint32_t vertex) const {
        return vertex_tiles.empty() ? TileIndex(0) : vertex_tiles[vertex];
    }

    /// The two vertices whose straight line carries edge k of a patch: its own, or the dominant side's at a
    /// seam. Given lower dominant first, so that both sides of an edge run it the same way; `is_reversed`
    /// tells whether that is against the patch's own direction (corner k to k + 1).
    struct EdgeLine {
        uint32_t first, second;
        bool is_reversed;
    };
    EdgeLine edge_line(uint32_t patch, int edge) const;
    /// Control points between the ends of the line of edge k, from its start; where the base is bicubic.
    std::array<Vec3f, 2> line_controls(uint32_t patch, int edge, const EdgeLine& line) const {
        if (controls.empty()) return {};
        const Vec3f* own = &controls[patch][size_t(2 * edge)];
        return {own[line.is_reversed ? 1 : 0], own[line.is_reversed ? 0 : 1]};
    }

    /// True on both sides of an edge whose patches join its ends by different vertices.
    bool is_seam(uint32_t patch, int edge) const { return overrides.contains(4 * patch + uint32_t(edge)); }

    /// Bytes of the arrays above except the map's texels and pyramid.
    size_t geometry_bytes() const;
};

/// Levels of one patch: its own and those of its four edges, each edge level <= the patch's.
struct PatchLevels {
    uint8_t patch = 0;
    std::array<uint8_t, 4> edge{};
    friend bool operator==(const PatchLevels&, const PatchLevels&) = default;

    /// Levels of surface M_k: every level lowered by `bias`, not below 0.
    PatchLevels biased(uint32_t bias) const {
        PatchLevels result;
        result.patch = uint8_t(scalar::lower_level(patch, bias));
        for (int k = 0; k < 4; ++k) result.edge[k] = uint8_t(scalar::lower_level(edge[k], bias));
        return result;
    }
};

/// 5 x 4 bits: patch level, then the edges.
inline uint32_t pack_levels(const PatchLevels& levels) {
    uint32_t packed = levels.patch;
    for (int k = 0; k < 4; ++k) packed |= uint32_t(levels.edge[k]) << (4 + 4 * k);
    return packed;
}

inline PatchLevels unpack_levels(uint32_t packed) {
    PatchLevels levels;
    levels.patch = uint8_t(scalar::packed_patch_level(packed));
    for (uint32_t k = 0; k < 4; ++k) levels.edge[k] = uint8_t(scalar::packed_edge_level(packed, k));
    return levels;
}

class PyramidCache;
class SubdivisionMesh;

/// What surfaces are made with, apart from mesh and displacement.
struct SurfaceContext {
    Affine object_from_world;         ///< used by world-space displacement only
    PyramidCache* pyramids = nullptr; ///< surfaces made with the same one share the bounds of their textures
    /// Which of the mesh's further uvs textures are on, and kOwnUvSet where some are to be read on its own
    /// uvs with the offsets of tiles.
    std::span<const int> uv_sets;
    /// How near automatic subdivision has to come to the limit surface; nullopt: 1/8192 of the diagonal of
    /// the mesh, for callers without a view.
    std::optional<BaseTolerance> tolerance;
    /// The limit surface of the mesh without further uv sets, if it is there already; used where levels are
    /// automatic and no further set is wanted.
    const SubdivisionMesh* limit = nullptr;
};

/// Makes a surface from polygons. With a displacement every face becomes quads (one linear Catmull-Clark
/// refinement of the whole mesh where a face is not a convex quad; concave faces are cut into triangles
/// first), and points at exactly equal positions are one point; without, n-gons and concave quads are cut
/// into triangles. Corners that repeat the position of the
/// corner before are dropped, so a quad with a collapsed edge counts as a triangle. Throws bad_input with
/// mesh and face: missing uv, index out of range, no face with an area, a value that is not finite or
/// absurdly large.
Surface make_surface(const Mesh& mesh, const Displacement* displacement, const SurfaceContext& context);

/// Sample (i, j) of a patch in [0, 2^level]^2, object space, by definition: edge samples lie on the edge's
/// line, snapped to its level; corners are the dominant vertex's; the rest is the bilinear patch displaced.
Vec3f evaluate_vertex(const Surface& surface, uint32_t patch, const PatchLevels& levels, uint32_t i,
                      uint32_t j);

/// Displacement vector (object space, before frames: raw d) at a local uv of copy `mip` of a tile: bilinear,
/// or by the spline where the map is smooth.
Vec3f fetch_displacement(const DisplacementMap& map, TileIndex tile, const Vec2f& uv, uint32_t mip = 0);

/// Point and two derivatives of the displaced patch for shading: derivatives of the map by central
/// differences one cell of `level` wide, those of the base turned into the plane of the interpolated vertex
/// normal, so that the normal is continuous across cells and across patches of a smooth mesh that have the
/// same level. The result points to the side of the winding.
Vec3f compute_shading_normal(const Surface& surface, uint32_t patch, int level, float u, float v);

/// Box of every vertex that the patch has at any level and bias, every ulp included.
Box compute_patch_box(const Surface& surface, uint32_t patch);

/// The cells [i0, i1) x [j0, j1) of a patch, as i0, j0, i1, j1.
using Cells = std::array<uint32_t, 4>;

/// Box of each part of a patch at its levels: all its vertices, moved samples included.
void compute_tile_boxes(const Surface& surface, uint32_t patch, const PatchLevels& levels,
                        std::span<const Cells> parts, std::span<Box> boxes);
Box compute_tile_box(const Surface& surface, uint32_t patch, const PatchLevels& levels, const Cells& part);

} // namespace relief
