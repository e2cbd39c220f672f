#include "surface/mesh/base_heights.h"

#include <algorithm>
#include <cmath>

#include "formulas/terminator.h"
#include "math/vec_double.h"

namespace relief {

namespace {

using Square = std::array<Vec2<double>, 4>;

constexpr Square kSquare = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

/// A face of the mesh by what its quads know of it.
struct Face {
    std::vector<Vec3d> corners, normals;
    Vec3d normal{}; ///< unit
    bool has_parts = false;

    uint32_t size() const { return uint32_t(corners.size()); }
};

/// Share of each corner of a face in the point at `at` of its square, or of its part.
void weigh_corners(const Face& face, uint32_t part, const Vec2<double>& at, std::vector<double>& weights) {
    const uint32_t size = face.size();
    weights.resize(size);
    const std::array<double, 4> of_square = {(1 - at.x) * (1 - at.y), at.x * (1 - at.y), at.x * at.y,
                                             (1 - at.x) * at.y};
    if (!face.has_parts) {
        std::copy(of_square.begin(), of_square.end(), weights.begin());
        return;
    }
    for (double& weight : weights) weight = of_square[2] / size;
    weights[part] += of_square[0] + (of_square[1] + of_square[3]) / 2;
    weights[(part + 1) % size] += of_square[1] / 2;
    weights[(part + size - 1) % size] += of_square[3] / 2;
}

/// Half of what the planes at the corners say, as in blend_tangent_heights(), of both signs.
double find_height(const Face& face, const std::vector<double>& weights) {
    Vec3d at{};
    for (size_t k = 0; k < weights.size(); ++k) at += face.corners[k] * weights[k];
    double sum = 0;
    for (size_t k = 0; k < weights.size(); ++k) {
        const double cosine = dot(face.normals[k], face.normal);
        if (std::fabs(cosine) >= double(scalar::kLeastCornerCosine))
            sum += weights[k] * dot(face.corners[k] - at, face.normals[k]) / cosine;
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
        face.corners.resize(face.has_parts ? last_part + 1 : 4), face.normals.resize(face.corners.size());
        for (uint32_t quad = first; quad < end; ++quad)
            for (uint32_t k = 0; k < 4; ++k) {
                const auto corner = std::ranges::find(kSquare, places[quad].corners[k]);
                if (corner == kSquare.end() || (face.has_parts && corner != kSquare.begin())) continue;
                const size_t number = face.has_parts ? places[quad].part : size_t(corner - kSquare.begin());
                face.corners[number] = get_position(4 * quad + k);
                face.normals[number] = get_normal(4 * quad + k);
            }
        Vec3d sum{};
        for (uint32_t k = 1; k + 1 < face.size(); ++k)
            sum += cross(face.corners[k] - face.corners[0], face.corners[k + 1] - face.corners[0]);
        face.normal = normalize_double(sum);
        return face;
    }

  private:
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
    std::vector<double> weights;
    bool is_any = false;
    for (uint32_t first = 0, end = 0; first < places.size(); first = end) {
        while (end < places.size() && places[end].face == places[first].face) ++end;
        const Face face = reader.read(first, end);
        for (uint32_t quad = first; quad < end; ++quad)
            for (uint32_t k = 0; k < 4; ++k) {
                weigh_corners(face, places[quad].part, places[quad].corners[k], weights);
                const double height = find_height(face, weights);
                const uint32_t point = quads.points[4 * quad + k];
                sums[point] += height, ++counts[point];
                is_any =
                    is_any || std::fabs(height) > 1e-6 * compute_length(face.corners[1] - face.corners[0]);
            }
    }
    if (!is_any) return {};
    std::vector<float> heights(sums.size());
    for (size_t point = 0; point < sums.size(); ++point)
        heights[point] = counts[point] > 0 ? float(sums[point] / counts[point]) : 0.0f;
    return heights;
}

} // namespace relief
