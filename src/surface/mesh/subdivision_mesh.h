// Polygons as OpenSubdiv sees them: refined topology, and the limit surface of each face (Catmull and Clark
// 1978; semi-sharp creases after DeRose, Kass and Truong 1998). The only place with OpenSubdiv.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "math/vec_double.h"
#include "surface/mesh/cage.h"
#include "surface/mesh/limit_face.h"
#include "surface/mesh/polygons.h"

namespace relief {

/// Quads of a mesh refined to its level.
struct RefinedMesh {
    uint32_t point_count = 0;
    std::vector<std::array<uint32_t, 4>> points; ///< one a quad
    std::vector<std::array<Vec2f, 4>> uvs;       ///< one a quad, or empty
    std::vector<QuadPlace> places;               ///< one a quad; those of a face follow one another
    std::vector<std::array<uint32_t, 4>> edges;  ///< one a quad: numbers of its sides
    std::vector<uint32_t> first_quads;           ///< lowest quad of each edge
    std::vector<bool> is_sharp;                  ///< one an edge: a boundary, or a crease that stays
    std::vector<float> semi_sharpness;           ///< one an edge: what is left of a crease that wears off
    std::vector<float> point_sharpness; ///< one a point: what is left of a sharp point that wears off
    std::vector<bool> is_bent;          ///< one an edge: no cubic, though between regular points
    std::vector<bool> is_regular;       ///< one a point: the limit is bicubic in the quads around it
    bool is_adaptive = false;           ///< quads may cross the borders between polynomials of their face
    std::vector<bool> is_straight;      ///< one a point: regular but for a semi-sharp crease straight through
    std::vector<Vec3d> limit_normals;   ///< one a point: where it is irregular and smooth, else (0, 0, 0)

    /// Control points of patches that are fitted already, in the order of InnerControls; and per quad the
    /// number of its own, or kNoIndex. Empty: none is.
    std::vector<std::array<Vec3d, 12>> fitted;
    std::vector<uint32_t> fits;

    /// One a quad, of each further set of the polygons.
    std::vector<std::vector<std::array<Vec2f, 4>>> further_uvs;

    uint32_t quad_count() const { return uint32_t(points.size()); }
};

/// Immutable for its users. Several threads may make and evaluate faces, but each face is made and evaluated
/// by one thread at a time. The cage is made by the first thread that asks for it, while no other does.
class SubdivisionMesh {
  public:
    /// The scheme must not be `none`. Throws bad_input with mesh and points for non-manifold or
    /// inconsistently wound edges, for creases along no edge, and for what OpenSubdiv refuses.
    SubdivisionMesh(const Polygons& polygons, const Subdivision& subdivision);
    ~SubdivisionMesh();

    /// Levels that the mesh is refined by: at least 1 where a face is no quad.
    int level() const;
    /// Patches at that level.
    uint64_t quad_count() const;
    /// Throws out_of_memory if the patches are too many, or need more memory than there is; `where` names
    /// file and mesh.
    RefinedMesh refine(const std::string& where);
    /// Points after `level` steps, not on the limit; after refine().
    std::vector<Vec3f> compute_points() const;
    /// The faces with limit uvs and what is known about their points. For a mesh that is not refined.
    const Cage& cage() const;
    /// Limit positions of a face. With automatic levels the mesh keeps what takes long to make. Throws
    /// bad_input for a face without a limit surface.
    LimitFace make_face(uint32_t face) const;
    /// Limit uvs of a face in set `set` of Cage::uvs.
    LimitFace make_uv_face(uint32_t face, uint32_t set) const;
    /// Whether uvs are smooth within faces, and not bilinear.
    bool has_smooth_uvs() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace relief
