#include "surface/mesh/base_heights.h"

#include <algorithm>
#include <cmath>

#include "formulas/terminator.h"
#include "math/vec_double.h"

namespace relief {

namespace {

using Square = std::array<Vec2<double>, 4>;

constexpr Square kSquare = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

/// A corner of a face and the plane through it along its normal: the plane is `height - dot(slope, p)` away
/// from a point p, measured along the face's normal. All relative to the first corner of the face.
struct CornerPlane {
    Vec3d place{}, slope{}; ///< slope and height are 0 where the plane is too steep
    double height = 0;

    CornerPlane& operator+=(const CornerPlane& other) {
        place += other.place, slope += other.slope, height += other.height;
        return *this;
    }
};

/// A face of the mesh, as far as its quads know it.
struct Face {
    std::vector<CornerPlane> corners;
    CornerPlane sum; ///< of all corners
    double size = 0; ///< length of the first edge
    bool has_parts = false;
};

/// Shares of the corners of a face in a point: one that each corner has, and more of up to four corners.
struct CornerShares {
    double each = 0;
    std::array<uint32_t, 4> corners{};
    std::array<double, 4> more{};
};

/// Finds the shares in the point at `at` of the face's square, or of its part.
CornerShares find_shares(const Face& face, uint32_t part, const Vec2<double>& at) {
    const std::array<double, 4> of_square = {(1 - at.x) * (1 - at.y), at.x * (1 - at.y), at.x * at.y,
                                             (1 - at.x) * at.y};
    if (!face.has_parts) return {0, {0, 1, 2, 3}, of_square};
    const auto size = uint32_t(face.corners.size());
    return {of_square[2] / size,
            {part, (part + 1) % size, (part + size - 1) % size, part},
            {of_square[0] + (of_square[1] + of_square[3]) / 2, of_square[1] / 2, of_square[3] / 2, 0}};
}

/// Half of the blended distances of the planes at the corners, as in blend_tangent_heights(), of both signs.
double find_height(const Face& face, const CornerShares& shares) {
    Vec3d at = face.sum.place * shares.each;
    for (size_t k = 0; k < 4; ++k) at += face.corners[shares.corners[k]].place * shares.more[k];
    double sum = shares.each * (face.sum.height - dot(at, face.sum.slope));
    for (size_t k = 0; k < 4; ++k) {
        const CornerPlane& corner = face.corners[shares.corners[k]];
        sum += shares.more[k] * (corner.height - dot(at, corner.slope));
    }
    return sum / 2;
}

/// The quads [first, end) are those of one face.
class FaceReader {
  public:
    explicit FaceReader(const FramedBase& framed) : framed_(framed) {}

    Face read(uint32_t first, uint32_t end) const {
        Face face;
        const std::vector<QuadPlace>& places = framed_.base.places;
        uint32_t last_part = 0;
        for (uint32_t quad = first; quad < end; ++quad) last_part = std::max(last_part, places[quad].part);
        face.has_parts = last_part > 0;
        std::vector<Vec3d> places_of(face.has_parts ? last_part + 1 : 4), normals(places_of.size());
        for (uint32_t quad = first; quad < end; ++quad)
            for (uint32_t k = 0; k < 4; ++k) {
                const auto corner = std::ranges::find(kSquare, places[quad].corners[k]);
                if (corner == kSquare.end() || (face.has_parts && corner != kSquare.begin())) continue;
                const size_t number = face.has_parts ? places[quad].part : size_t(corner - kSquare.begin());
                places_of[number] = get_position(4 * quad + k);
                normals[number] = get_normal(4 * quad + k);
            }
        add_planes(places_of, normals, face);
        return face;
    }

  private:
    static void add_planes(const std::vector<Vec3d>& places, const std::vector<Vec3d>& normals, Face& face) {
        Vec3d sum{};
        for (size_t k = 1; k + 1 < places.size(); ++k)
            sum += cross(places[k] - places[0], places[k + 1] - places[0]);
        const Vec3d face_normal = normalize_double(sum);
        for (size_t k = 0; k < places.size(); ++k) {
            CornerPlane plane;
            plane.place = places[k] - places[0];
            const double cosine = dot(normals[k], face_normal);
            if (std::fabs(cosine) >= double(scalar::kLeastCornerCosine))
                plane.slope = normals[k] * (1 / cosine);
            plane.height = dot(plane.place, plane.slope);
            face.corners.push_back(plane), face.sum += plane;
        }
        face.size = compute_length(places[1] - places[0]);
    }

    Vec3d get_position(uint32_t corner) const {
        const Polygons& quads = framed_.base.polygons;
        return to_double(quads.positions[quads.points[corner]]);
    }
    Vec3d get_normal(uint32_t corner) const {
        const Polygons& quads = framed_.base.polygons;
        return quads.normals.empty() ? framed_.point_normals[quads.points[corner]]
                                     : normalize_double(to_double(quads.normals[corner]));
    }

    const FramedBase& framed_;
};

} // namespace

std::vector<QuadPlace> list_parts(const Polygons& polygons) {
    std::vector<QuadPlace> places;
    for (uint32_t face = 0; face < polygons.face_count(); ++face)
        for (uint32_t k = 0; k < polygons.face_size(face); ++k) places.push_back({face, k, kSquare});
    return places;
}

std::vector<float> find_base_heights(const FramedBase& framed) {
    const std::vector<QuadPlace>& places = framed.base.places;
    const Polygons& quads = framed.base.polygons;
    if (places.empty()) return {};
    std::vector<double> sums(quads.positions.size());
    std::vector<uint32_t> counts(quads.positions.size());
    const FaceReader reader(framed);
    bool is_any = false;
    for (uint32_t first = 0, end = 0; first < places.size(); first = end) {
        while (end < places.size() && places[end].face == places[first].face) ++end;
        const Face face = reader.read(first, end);
        for (uint32_t quad = first; quad < end; ++quad)
            for (uint32_t k = 0; k < 4; ++k) {
                const double height =
                    find_height(face, find_shares(face, places[quad].part, places[quad].corners[k]));
                const uint32_t point = quads.points[4 * quad + k];
                sums[point] += height, ++counts[point];
                is_any = is_any || std::fabs(height) > 1e-6 * face.size;
            }
    }
    if (!is_any) return {};
    std::vector<float> heights(sums.size());
    for (size_t point = 0; point < sums.size(); ++point)
        heights[point] = counts[point] > 0 ? float(sums[point] / counts[point]) : 0.0f;
    return heights;
}

} // namespace relief
