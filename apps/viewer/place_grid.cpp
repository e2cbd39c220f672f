#include "viewer/place_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>

#include "common/vectors.h"

namespace relief::viewer {

using namespace vectors;

namespace {

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

/// Samples that may be visited for each sample of the grid and for each corner of the mesh: several times
/// what a mesh without overlaps needs.
constexpr int64_t kVisitsPerSample = 64, kVisitsPerCorner = 64;

bool is_there(const Vec3f& p) { return !std::isnan(p.x); }

/// Samples of one axis, inclusive.
struct SampleSpan {
    int first, last;
};

/// Samples between two places of an axis of `size` samples, and one more on either side; never one twice.
SampleSpan find_samples(double low, double high, int size, bool has_tiles) {
    const double first = std::floor(low) - 1, last = std::ceil(high);
    if (has_tiles)
        return {int(std::clamp(first, 0.0, double(size))), int(std::clamp(last, -1.0, size - 1.0))};
    if (last - first < size) return {int(first), int(last)};
    const int start = int(std::floor((low + high) / 2)) - size / 2;
    return {start, start + size - 1};
}

int repeat(int index, int size) { return (index % size + size) % size; }

/// Draws triangles until all samples are covered or no visits are left.
class TriangleDrawing {
  public:
    TriangleDrawing(int width, int height, const GridPlace& place, int64_t corners,
                    std::vector<Vec3f>& places)
        : width_(width),
          height_(height),
          place_(place),
          visits_left_(kVisitsPerSample * int64_t(places.size()) + kVisitsPerCorner * corners),
          uncovered_(places.size()),
          is_covered_(places.size()),
          places_(places) {}

    bool is_done() const { return uncovered_ == 0 || visits_left_ <= 0; }

    void draw(const Vec3f (&points)[3], const Vec2f (&uvs)[3]) {
        Triangle triangle{points, {}, 0};
        if (!locate(uvs, triangle)) return;
        const auto& at = triangle.at;
        const double area =
            (at[1].x - at[0].x) * (at[2].y - at[0].y) - (at[1].y - at[0].y) * (at[2].x - at[0].x);
        if (!(std::fabs(area) > 1e-12)) return;
        triangle.area = area;
        const auto [top, bottom] = std::minmax({at[0].y, at[1].y, at[2].y});
        const SampleSpan rows = find_samples(top, bottom, height_, place_.has_tiles);
        for (int y = rows.first; y <= rows.last; ++y) draw_row(triangle, y);
        visits_left_ -= std::max(0, rows.last - rows.first + 1);
    }

  private:
    struct Place {
        double x, y;
    };
    struct Triangle {
        const Vec3f (&points)[3];
        Place at[3]; ///< in samples
        double area; ///< twice, with its sign
    };

    /// False for a triangle outside of the square of the grid.
    bool locate(const Vec2f (&uvs)[3], Triangle& triangle) const {
        double u = place_.square.column, v = place_.square.row;
        if (place_.has_tiles) {
            const auto [left, right] = std::minmax({uvs[0].x, uvs[1].x, uvs[2].x});
            const auto [low, high] = std::minmax({uvs[0].y, uvs[1].y, uvs[2].y});
            if (!(right > u + kUvRounding && left < u + 1 - kUvRounding && high > v + kUvRounding &&
                  low < v + 1 - kUvRounding))
                return false;
        } else {
            u = std::floor((double(uvs[0].x) + uvs[1].x + uvs[2].x) / 3);
            v = std::floor((double(uvs[0].y) + uvs[1].y + uvs[2].y) / 3);
        }
        for (size_t k = 0; k < 3; ++k) {
            const double row = place_.flip_v ? uvs[k].y - v : 1 - (uvs[k].y - v);
            triangle.at[k] = {(uvs[k].x - u) * width_, row * height_};
        }
        return true;
    }

    void draw_row(const Triangle& triangle, int y) {
        const auto& at = triangle.at;
        const double area = triangle.area, py = y + 0.5 - at[0].y;
        // The second and the third corner have these weights at the column of the first one, and this growth
        // per column.
        const double b0 = -py * (at[2].x - at[0].x) / area, b1 = (at[2].y - at[0].y) / area;
        const double c0 = py * (at[1].x - at[0].x) / area, c1 = -(at[1].y - at[0].y) / area;
        const double margin = 1 / std::max(1.0, std::sqrt(std::fabs(area)));
        double left = std::min({at[0].x, at[1].x, at[2].x}), right = std::max({at[0].x, at[1].x, at[2].x});
        for (const auto& [weight, growth] : {std::pair(b0, b1), {c0, c1}, {1 - b0 - c0, -b1 - c1}}) {
            const double end = at[0].x + (-margin - weight) / growth;
            if (growth > 0) left = std::max(left, end - 1);
            if (growth < 0) right = std::min(right, end + 1);
            if (growth == 0 && weight < -margin) return;
        }
        if (!(left <= right)) return;
        const SampleSpan columns = find_samples(left, right, width_, place_.has_tiles);
        for (int x = columns.first; x <= columns.last; ++x) {
            const double px = x + 0.5 - at[0].x, b = b0 + b1 * px, c = c0 + c1 * px;
            const double inside = std::min({1 - b - c, b, c});
            if (inside >= -margin) put(triangle, x, y, inside >= 0, {b, c});
        }
        visits_left_ -= std::max(0, columns.last - columns.first + 1);
    }

    /// `weights` are those of the second and the third corner.
    void put(const Triangle& triangle, int x, int y, bool is_inside, const Place& weights) {
        const size_t index = size_t(repeat(y, height_)) * size_t(width_) + size_t(repeat(x, width_));
        Vec3f& place = places_[index];
        // Triangles that cover a sample win over those beside it.
        if (is_covered_[index] != 0 || (!is_inside && is_there(place))) return;
        if (is_inside) is_covered_[index] = 1, --uncovered_;
        const auto& p = triangle.points;
        place = p[0] + (p[1] - p[0]) * float(weights.x) + (p[2] - p[0]) * float(weights.y);
    }

    const int width_, height_;
    const GridPlace& place_;
    int64_t visits_left_;
    size_t uncovered_;
    std::vector<uint8_t> is_covered_; ///< by the inside of a triangle
    std::vector<Vec3f>& places_;
};

} // namespace

PlaceGrid::PlaceGrid(int width, int height)
    : width_(width), height_(height), places_(size_t(width) * size_t(height), {kNothing, 0, 0}) {}

void PlaceGrid::draw(const Mesh& mesh, const GridPlace& place) {
    TriangleDrawing drawing(width_, height_, place, int64_t(mesh.position_indices.size()), places_);
    size_t first = 0;
    for (const uint32_t size : mesh.face_sizes) {
        const auto position = [&](size_t k) { return mesh.positions[mesh.position_indices[first + k]]; };
        const auto uv = [&](size_t k) { return mesh.uvs[mesh.uv_indices[first + k]]; };
        if (mesh.uv_indices[first] != kNoIndex)
            for (size_t k = 2; k < size; ++k)
                drawing.draw({position(0), position(k - 1), position(k)}, {uv(0), uv(k - 1), uv(k)});
        if (drawing.is_done()) return;
        first += size;
    }
}

std::optional<Vec3f> PlaceGrid::find(float column, float row) const {
    const auto at = [&](int x, int y) {
        return places_[size_t(std::clamp(y, 0, height_ - 1)) * size_t(width_) +
                       size_t(std::clamp(x, 0, width_ - 1))];
    };
    const int x = int(std::floor(column - 0.5f)), y = int(std::floor(row - 0.5f));
    const float s = column - 0.5f - float(x), t = row - 0.5f - float(y);
    Vec3f sum{};
    float weights = 0;
    for (const auto& [dx, dy, weight] :
         {std::tuple{0, 0, (1 - s) * (1 - t)}, {1, 0, s * (1 - t)}, {0, 1, (1 - s) * t}, {1, 1, s * t}})
        if (const Vec3f place = at(x + dx, y + dy); is_there(place) && weight > 0)
            sum = sum + place * weight, weights += weight;
    if (weights <= 0) return std::nullopt;
    return sum * (1 / weights);
}

} // namespace relief::viewer
