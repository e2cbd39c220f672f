#include "convert/texel_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/progress.h"
#include "math/vec.h"
#include "math/vec_double.h"
#include "surface/map/texels.h"
#include "surface/patch/patch_samples.h"

namespace relief {

namespace {

constexpr double kReach = 1.5; ///< texels beside a patch

struct Point {
    double x = 0, y = 0;
};

/// Corners of a patch in texels of its tile, texel middles at .5, rows downwards.
std::array<Point, 4> place_corners(const Surface& surface, uint32_t patch, const Texture& texture) {
    std::array<Point, 4> corners;
    for (size_t k = 0; k < 4; ++k) {
        const Vec2f& uv = surface.uvs[surface.quads[patch].vertex[k]];
        const double v = surface.map.flip_v ? double(uv.y) : 1 - double(uv.y);
        corners[k] = {double(uv.x) * texture.width, v * texture.height};
    }
    return corners;
}

Point blend(const std::array<Point, 4>& c, double u, double v) {
    const auto mix = [&](double a, double b, double d, double e) {
        return (a * (1 - u) + b * u) * (1 - v) + (e * (1 - u) + d * u) * v;
    };
    return {mix(c[0].x, c[1].x, c[2].x, c[3].x), mix(c[0].y, c[1].y, c[2].y, c[3].y)};
}

/// Where a point lies on a patch, in [0, 1]^2, and how far beside it, in texels.
struct PatchPlace {
    double u = 0.5, v = 0.5, distance = 0;
};

/// Newton's method on the bilinear patch; nothing where it does not lead there.
std::optional<PatchPlace> find_place(const std::array<Point, 4>& c, const Point& p) {
    constexpr int kSteps = 12;
    PatchPlace place;
    for (int step = 0; step < kSteps; ++step) {
        const Point at = blend(c, place.u, place.v);
        const Point du{(c[1].x - c[0].x) * (1 - place.v) + (c[2].x - c[3].x) * place.v,
                       (c[1].y - c[0].y) * (1 - place.v) + (c[2].y - c[3].y) * place.v};
        const Point dv{(c[3].x - c[0].x) * (1 - place.u) + (c[2].x - c[1].x) * place.u,
                       (c[3].y - c[0].y) * (1 - place.u) + (c[2].y - c[1].y) * place.u};
        const double determinant = du.x * dv.y - du.y * dv.x;
        if (determinant == 0) return std::nullopt;
        const double x = p.x - at.x, y = p.y - at.y;
        place.u = std::clamp(place.u + (x * dv.y - y * dv.x) / determinant, -1.0, 2.0);
        place.v = std::clamp(place.v + (du.x * y - du.y * x) / determinant, -1.0, 2.0);
    }
    place.u = std::clamp(place.u, 0.0, 1.0), place.v = std::clamp(place.v, 0.0, 1.0);
    const Point at = blend(c, place.u, place.v);
    place.distance = compute_length(p.x - at.x, p.y - at.y);
    if (!(place.distance <= kReach)) return std::nullopt;
    return place;
}

TexelFrame blend_frames(const std::array<VertexData, 4>& corners, float u, float v) {
    const Frame frame = blend_corners(corners, u, v).frame;
    TexelFrame result{{frame.t, frame.b, frame.n}, {}};
    const std::array<float, 4> weights{(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
    for (size_t k = 0; k < 4; ++k) {
        const Frame& corner = corners[k].frame;
        result.lengths[0] += weights[k] * length(corner.t);
        result.lengths[1] += weights[k] * length(corner.b);
        result.lengths[2] += weights[k] * length(corner.n);
    }
    return result;
}

class FrameVisitor {
  public:
    FrameVisitor(const Surface& surface, TileIndex tile)
        : surface_(surface),
          texture_(*surface.map.tiles[tile].texture),
          distances_(size_t(texture_.width) * texture_.height, std::numeric_limits<float>::infinity()) {}

    template <class Visit> void visit_patch(uint32_t patch, const Visit& visit) {
        const std::array<Point, 4> corners = place_corners(surface_, patch, texture_);
        const auto [left, right] = std::minmax({corners[0].x, corners[1].x, corners[2].x, corners[3].x});
        const auto [top, bottom] = std::minmax({corners[0].y, corners[1].y, corners[2].y, corners[3].y});
        // A patch that runs round the map many times has each texel many times; once is enough.
        if (right - left > 4.0 * texture_.width || bottom - top > 4.0 * texture_.height) return;
        const PatchSamples samples(surface_, patch);
        for (int64_t y = int64_t(std::floor(top - kReach)); double(y) <= bottom + kReach; ++y)
            for (int64_t x = int64_t(std::floor(left - kReach)); double(x) <= right + kReach; ++x) {
                const auto place = find_place(corners, {double(x) + 0.5, double(y) + 0.5});
                if (place) visit_texel(samples, x, y, *place, visit);
            }
    }

  private:
    template <class Visit>
    void visit_texel(const PatchSamples& samples, int64_t x, int64_t y, const PatchPlace& place,
                     const Visit& visit) {
        const bool is_inside = x >= 0 && y >= 0 && x < texture_.width && y < texture_.height;
        if (!is_inside && surface_.map.wrap != WrapMode::repeat) return;
        const auto column = uint32_t(wrap_index(x, texture_.width, surface_.map.wrap));
        const auto row = uint32_t(wrap_index(y, texture_.height, surface_.map.wrap));
        float& distance = distances_[size_t(row) * texture_.width + column];
        if (!(float(place.distance) < distance)) return;
        distance = float(place.distance);
        visit(column, row, blend_frames(samples.corners(), float(place.u), float(place.v)));
    }

    const Surface& surface_;
    const Texture& texture_;
    std::vector<float> distances_;
};

} // namespace

void visit_texel_frames(const Surface& surface, TileIndex tile,
                        const std::function<void(uint32_t, uint32_t, const TexelFrame&)>& visit,
                        const ProgressFunction& on_progress) {
    FrameVisitor visitor(surface, tile);
    ProgressCounter counter(on_progress, surface.patch_count());
    for (uint32_t patch = 0; patch < surface.patch_count(); ++patch) {
        if (surface.tile(surface.quads[patch].vertex[0]) == tile) visitor.visit_patch(patch, visit);
        counter.add(1);
    }
}

} // namespace relief
