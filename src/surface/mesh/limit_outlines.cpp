#include "surface/mesh/limit_outlines.h"

#include <array>
#include <optional>
#include <vector>

#include "relief/scene.h"
#include "surface/mesh/uv_matching.h"

namespace relief {

namespace {

constexpr int kPieces = 8; // of a curved side

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

} // namespace

void visit_limit_outlines(const SubdivisionMesh& mesh,
                          const std::function<void(std::span<const Vec2f>)>& visit) {
    const Cage cage = mesh.make_cage();
    if (!cage.has_uvs) return;
    const std::vector<uint8_t> is_inner = find_inner_edges(cage, cage.uvs[0]);
    std::vector<Vec2f> outline;
    for (uint32_t face = 0; face < cage.face_count(); ++face) {
        outline.clear();
        std::optional<LimitFace> limit;
        const uint32_t start = cage.starts[face], size = cage.face_size(face);
        for (uint32_t k = 0; k < size; ++k) {
            outline.push_back(cage.uvs[0][start + k]);
            if (is_inner[cage.edges[start + k]]) continue;
            if (!limit) limit.emplace(mesh.make_uv_face(face, 0));
            for (int piece = 1; piece < kPieces; ++piece) {
                const double s = double(piece) / kPieces;
                // Half of a polygon's side is a side of the part at its begin, half of that at its end.
                const bool is_second = s > 0.5;
                const uint32_t part = size == 4 ? 0 : is_second ? (k + 1) % size : k;
                const Vec2<double> place = size == 4   ? find_place_on_side(k, s)
                                           : is_second ? Vec2<double>{0, 2 - 2 * s}
                                                       : Vec2<double>{2 * s, 0};
                const Vec3d uv = limit->evaluate_position(part, place.x, place.y);
                outline.push_back({float(uv.x), float(uv.y)});
            }
        }
        visit(outline);
    }
}

} // namespace relief
