#include "surface/mesh/base_frames.h"

#include <algorithm>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "relief/error.h"
#include "surface/mesh/base_heights.h"
#include "surface/mesh/mikk_tangents.h"

namespace relief {

namespace {

/// Quads, smooth where the mesh says so.
SmoothBase make_base(Polygons polygons, const Subdivision& subdivision, const BaseNeeds& base_needs) {
    if (subdivision.scheme != SubdivisionScheme::catmark) polygons = cut_concave_faces(std::move(polygons));
    if (subdivision.scheme != SubdivisionScheme::none) return subdivide(polygons, subdivision, base_needs);
    SmoothBase base;
    bool is_all_quads = true;
    for (uint32_t face = 0; face < polygons.face_count(); ++face)
        is_all_quads = is_all_quads && polygons.face_size(face) == 4;
    if (!is_all_quads) base.places = list_parts(polygons);
    base.polygons = is_all_quads ? std::move(polygons) : refine_to_quads(polygons);
    return base;
}

bool uses_normals(const Displacement& displacement) {
    return displacement.type == DisplacementType::height || displacement.space == DisplacementSpace::tangent;
}

bool uses_tangents(const Displacement& displacement) {
    return displacement.type == DisplacementType::vector && displacement.space == DisplacementSpace::tangent;
}

void check_file_frames(const Polygons& polygons, const Mesh& mesh, const Displacement& displacement) {
    const auto refuse = [&](const char* message, const char* hint) {
        throw Error(ErrorKind::bad_input, {fmt::format("{}, and displacement '{}' has \"frame\": \"file\"",
                                                       message, displacement.name),
                                           polygons.where, hint});
    };
    if (mesh.subdivision.scheme != SubdivisionScheme::none)
        refuse("mesh is subdivided, which leaves the normals of its file behind",
               "use frame mikk or dpdu, or scheme none");
    if (polygons.normals.empty())
        refuse("mesh has no normals", "export it with normals, or use frame mikk or dpdu");
    if (uses_tangents(displacement) && displacement.lengths == FrameLengths::relative)
        refuse("the file's tangents have no lengths for relative ones",
               "use lengths absolute, or frame mikk or dpdu");
}

/// Makes normals unit length; those that have none become their faces'.
void clean_normals(Polygons& polygons) {
    for (uint32_t face = 0; face < polygons.face_count(); ++face)
        for (uint32_t corner = polygons.starts[face]; corner < polygons.starts[face + 1]; ++corner) {
            Vec3d normal = normalize_double(to_double(polygons.normals[corner]));
            if (normal == Vec3d{}) normal = normalize_double(compute_newell_normal(polygons, face));
            polygons.normals[corner] = to_float(normal) + Vec3f{}; // -0 becomes 0
        }
}

bool has_large_faces(const Polygons& polygons) {
    for (uint32_t face = 0; face < polygons.face_count(); ++face)
        if (polygons.face_size(face) > 4) return true;
    return false;
}

/// Of quads whose first points may have got theirs from the faces of the mesh.
std::vector<Vec3d> make_point_normals(const SmoothBase& base, SummedNormals summed,
                                      const std::vector<Vec3d>& known) {
    std::vector<Vec3d> normals;
    if (base.point_normals.empty()) {
        normals = compute_point_normals(base.polygons, summed);
        std::copy(known.begin(), known.end(), normals.begin());
        return normals;
    }
    normals.reserve(base.point_normals.size());
    for (const Vec3f& normal : base.point_normals) normals.push_back(normalize_double(to_double(normal)));
    return normals;
}

/// What a displacement requires of a mesh.
struct FrameNeeds {
    bool is_smooth, has_file_normals, has_file_tangents, is_mikk;
    SummedNormals summed;

    FrameNeeds(const Polygons& polygons, const Mesh& mesh, const Displacement& displacement)
        : is_smooth(mesh.subdivision.scheme != SubdivisionScheme::none),
          has_file_normals(uses_normals(displacement) && displacement.frame == FrameKind::file),
          has_file_tangents(has_file_normals && uses_tangents(displacement) && !polygons.tangents.empty()),
          is_mikk(uses_tangents(displacement) && displacement.frame != FrameKind::dpdu && !has_file_tangents),
          summed(uses_normals(displacement) && displacement.frame == FrameKind::mikk
                     ? SummedNormals::faces
                     : SummedNormals::corners) {}
};

} // namespace

FramedBase make_framed_base(Polygons polygons, const Mesh& mesh, const Displacement& displacement,
                            const BaseNeeds& base_needs) {
    const FrameNeeds needs(polygons, mesh, displacement);
    if (needs.has_file_normals) {
        check_file_frames(polygons, mesh, displacement);
        clean_normals(polygons);
    } else {
        polygons.normals.clear();
    }
    if (!needs.has_file_tangents) polygons.tangents.clear();
    const auto add_tangents = [&](Polygons& faces, const std::vector<Vec3d>& normals) {
        add_mikk_tangents(faces, needs.has_file_normals ? std::span<const Vec3d>() : normals,
                          displacement.lengths);
    };
    FramedBase result;
    const bool is_mikk_first = needs.is_mikk && !needs.is_smooth && !has_large_faces(polygons);
    if (!needs.is_smooth && needs.summed == SummedNormals::faces)
        result.point_normals = compute_point_normals(polygons, needs.summed);
    if (is_mikk_first) add_tangents(polygons, result.point_normals);
    result.base = make_base(std::move(polygons), mesh.subdivision, base_needs);
    Polygons& quads = result.base.polygons;
    if (!needs.has_file_normals) quads.normals.clear();
    if (result.point_normals.size() != quads.positions.size())
        result.point_normals = make_point_normals(result.base, needs.summed, result.point_normals);
    if (needs.is_mikk && !is_mikk_first) add_tangents(quads, result.point_normals);
    return result;
}

} // namespace relief
