#include "surface/mesh/uv_outlines.h"

#include <array>
#include <optional>

#include "base/parallel.h"
#include "relief/scene.h"
#include "surface/mesh/uv_matching.h"

namespace relief {

namespace {

constexpr size_t kPieces = 8; // of a curved side

/// Per edge whether its two faces have the same uvs along it.
std::vector<uint8_t> find_inner_edges(const Cage& cage, const std::vector<Vec2f>& uvs) {
    std::vector<uint32_t> first(cage.is_sharp.size(), kNoIndex);
    std::vector<uint8_t> is_inner(cage.is_sharp.size());
    const auto next = [&](uint32_t face, uint32_t corner) {
        return corner + 1 < cage.starts[face + 1] ? corner + 1 : cage.starts[face];
    };
    std::vector<uint32_t> face_of_corner(cage.points.size());
    for (uint32_t face = 0; face < cage.face_count(); ++face)
        for (uint32_t corner = cage.starts[face]; corner < cage.starts[face + 1]; ++corner) {
            face_of_corner[corner] = face;
            uint32_t& other = first[cage.edges[corner]];
            if (other == kNoIndex) {
                other = corner;
                continue;
            }
            // Neighbours run along their edge in opposite directions.
            is_inner[cage.edges[corner]] = uvs[corner] == uvs[next(face_of_corner[other], other)] &&
                                           uvs[next(face, corner)] == uvs[other];
        }
    return is_inner;
}

/// Point s of side k of a face with `size` sides. Half of a polygon's side is a side of the part at its
/// begin, the other half one of the part at its end.
Vec2f evaluate_side(const LimitFace& limit, uint32_t size, uint32_t k, double s) {
    const bool is_second = s > 0.5;
    const uint32_t part = size == 4 ? 0 : is_second ? (k + 1) % size : k;
    const Vec2<double> place = size == 4   ? find_place_on_side(k, s)
                               : is_second ? Vec2<double>{0, 2 - 2 * s}
                                           : Vec2<double>{2 * s, 0};
    const Vec3d uv = limit.evaluate_position(part, place.x, place.y);
    return {float(uv.x), float(uv.y)};
}

/// Outlines of the patches at the mesh's level.
UvOutlines make_patch_outlines(const Mesh& mesh) {
    UvOutlines outlines;
    const Polygons polygons = make_polygons(mesh, Welding::joined_points);
    const RefinedMesh refined = SubdivisionMesh(polygons, mesh.subdivision).refine(polygons.where);
    for (const std::array<Vec2f, 4>& uvs : refined.uvs) {
        outlines.uvs.insert(outlines.uvs.end(), uvs.begin(), uvs.end());
        outlines.end_face();
    }
    return outlines;
}

UvOutlines make_flat_outlines(const Mesh& mesh) {
    UvOutlines outlines;
    size_t first = 0;
    for (const uint32_t size : mesh.face_sizes) {
        if (first + size > mesh.uv_indices.size()) break;
        for (size_t k = first; k < first + size; ++k)
            if (mesh.uv_indices[k] < mesh.uvs.size()) outlines.uvs.push_back(mesh.uvs[mesh.uv_indices[k]]);
        if (outlines.uvs.size() - outlines.starts.back() == size)
            outlines.end_face();
        else
            outlines.uvs.resize(outlines.starts.back());
        first += size;
    }
    return outlines;
}

bool has_smooth_uvs(const Mesh& mesh) {
    return mesh.subdivision.scheme == SubdivisionScheme::catmark && mesh.subdivision.uv == UvRule::smooth;
}

} // namespace

bool has_curved_outlines(const Mesh& mesh) {
    return has_smooth_uvs(mesh) && mesh.subdivision.level == kAutoSubdivisionLevel;
}

UvOutlines make_uv_outlines(const Mesh& mesh) {
    if (!has_smooth_uvs(mesh)) return make_flat_outlines(mesh);
    if (!has_curved_outlines(mesh)) return make_patch_outlines(mesh);
    const Polygons polygons = make_polygons(mesh, Welding::joined_points);
    return make_uv_outlines(SubdivisionMesh(polygons, mesh.subdivision));
}

UvOutlines make_uv_outlines(const SubdivisionMesh& mesh) {
    UvOutlines outlines;
    const Cage& cage = mesh.cage();
    if (!cage.has_uvs) return outlines;
    const std::vector<Vec2f>& corners = cage.uvs[0];
    const std::vector<uint8_t> is_inner = find_inner_edges(cage, corners);
    std::vector<size_t> starts{0};
    for (uint32_t face = 0; face < cage.face_count(); ++face) {
        starts.push_back(starts.back());
        for (uint32_t corner = cage.starts[face]; corner < cage.starts[face + 1]; ++corner)
            starts.back() += is_inner[cage.edges[corner]] ? 1 : kPieces;
    }
    outlines.uvs.resize(starts.back());
    parallel_for("outlines of faces", cage.face_count(), 256, [&](size_t begin, size_t end) {
        for (uint32_t face = uint32_t(begin); face < end; ++face) {
            Vec2f* next = &outlines.uvs[starts[face]];
            std::optional<LimitFace> limit;
            const uint32_t start = cage.starts[face], size = cage.face_size(face);
            for (uint32_t k = 0; k < size; ++k) {
                *next++ = corners[start + k];
                if (is_inner[cage.edges[start + k]]) continue;
                if (!limit) limit.emplace(mesh.make_uv_face(face, 0));
                for (size_t piece = 1; piece < kPieces; ++piece)
                    *next++ = evaluate_side(*limit, size, k, double(piece) / kPieces);
            }
        }
    });
    outlines.starts = std::move(starts);
    return outlines;
}

} // namespace relief
