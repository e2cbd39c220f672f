// How SubdivisionMesh holds its mesh for OpenSubdiv; for the sources that implement it only.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>
#include <utility>
#include <vector>

#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/far/primvarRefiner.h>

#include "surface/mesh/limit_cells.h"
#include "surface/mesh/subdivision_mesh.h"
#include "surface/mesh/uv_topology.h"

namespace relief {

namespace osd = OpenSubdiv;

using Cache = osd::Bfr::SurfaceFactoryCacheThreaded<std::shared_mutex, std::shared_lock<std::shared_mutex>,
                                                    std::unique_lock<std::shared_mutex>>;
using Factory = osd::Bfr::RefinerSurfaceFactory<Cache>;
using RefinerPointer = std::unique_ptr<osd::Far::TopologyRefiner>;

/// What primvars of OpenSubdiv must be able to do.
template <class Value> struct Blended {
    Value value{};
    void Clear(void* = nullptr) { value = Value{}; }
    void AddWithWeight(const Blended& other, double weight) { value = value + other.value * weight; }
};
using BlendedUv = Blended<Vec2<double>>;
using BlendedPoint = Blended<Vec3d>;

inline Vec3d read(const double* p) { return {p[0], p[1], p[2]}; }
inline bool is_semi_sharp(float sharpness) { return sharpness > 0 && sharpness < kInfiniteSharpness; }

/// Cell (i, j) of a face or part, and its axes.
struct CellOrigin {
    uint32_t face = 0, part = 0, i = 0, j = 0;
};

struct LimitFace::Surface {
    std::vector<LimitCells> cells; ///< one per part, or of a quad; if there are any, nothing else is used
    osd::Bfr::Surface<double> surface;
    std::vector<double> points;
    osd::Bfr::Parameterization parameters;
};

/// Whether the quads around a point are bicubic on each side of what stays sharp, as far as the point's own
/// sharpness and edges decide that.
bool is_regular_point(const osd::Far::TopologyLevel& level, int point);

/// Whether all faces at a point are quads.
bool has_quads_only(const osd::Far::TopologyLevel& level, int point);

/// Whether no boundary and no crease passes a point.
bool is_smooth_point(const osd::Far::TopologyLevel& level, int point);

/// Whether one semi-sharp crease, which does not change, is all that keeps a point from being regular.
bool is_straight_point(const osd::Far::TopologyLevel& level, int point);

/// Corner k of a quad is at (u, v) = kCorner[k].
inline constexpr std::array<std::array<uint32_t, 2>, 4> kCorner = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

struct SubdivisionMesh::Implementation {
    std::string where;
    int level = 0;
    std::vector<UvTopology> uv_sets; ///< a channel each: first that of the mesh, if it has one
    bool has_uvs = false;            ///< it has one
    bool has_smooth_uvs = false;
    std::vector<double> positions;
    std::vector<std::vector<double>> uv_points; ///< per set: its values as (u, v, 0)
    std::vector<bool> is_bicubic;               ///< per face: its limit is one polynomial
    /// Per set and face: kSplineUvs if the limit of its uvs is one polynomial, and bit k if uvs are apart
    /// across side k. Empty: not known for any.
    std::vector<std::vector<uint8_t>> spline_uvs;
    static constexpr uint8_t kSplineUvs = 16;
    /// Per face: its limit surface where it is no polynomial, and per set that of its uvs, for the next time;
    /// empty: nothing is kept.
    mutable std::vector<std::shared_ptr<const LimitFace::Surface>> kept_faces;
    mutable std::vector<std::vector<std::shared_ptr<const LimitFace::Surface>>> kept_uv_faces;
    mutable std::optional<Cage> known_cage; ///< once asked for
    RefinerPointer refiner;
    std::optional<Factory> factory, uv_factory;

    void check_edges(const Polygons& polygons) const;
    void check_points(const Polygons& polygons) const;
    void check_creases(const Polygons& polygons) const;
    void find_bicubic_faces();
    void find_spline_uvs();
    uint8_t find_spline_uvs_of(uint32_t face, int channel) const;
    std::pair<uint32_t, bool> find_irregular_corners(uint32_t face) const;
    bool is_bicubic_in_set(uint32_t face, int channel) const {
        return !spline_uvs.empty() && (spline_uvs[size_t(channel)][face] & kSplineUvs) != 0;
    }
    bool is_seam(uint32_t face, int side, int channel) const;
    bool has_spline_uvs_at(uint32_t face, int corner, int channel) const;
    template <class Read, class Sharp>
    SplineControls find_controls(uint32_t face, const Read& read_corner, const Sharp& is_sharp_side) const;
    template <class Read> std::vector<LimitCells> find_cells(uint32_t face, const Read& read_corner) const;
    int get_depth(uint32_t face) const;
    std::vector<CellOrigin> find_origins() const;
    std::vector<QuadPlace> find_places() const;
    std::vector<Vec2f> find_limit_uv_values(int channel) const;
    std::vector<Vec2f> find_base_uv_values(int channel) const;
    LimitFace make_face(uint32_t face) const;
    LimitFace make_uv_face(uint32_t face, int channel) const;
    Cage make_cage() const;
    /// Per corner of the refined mesh.
    std::vector<Vec2f> find_limit_uvs(int channel) const;
    std::vector<BlendedPoint> refine_points() const;
    std::vector<Vec3d> find_limit_normals(const std::vector<bool>& is_regular) const;
    void copy_quads(RefinedMesh& refined) const;
};

} // namespace relief
