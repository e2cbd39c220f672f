#include "bench/doubtful_hits.h"

#include <algorithm>

#include "bench/tree_rays.h"

namespace relief::bench {

namespace {

/// Tolerance for rounding of the intervals here and of hit distances; smaller than the slack of the
/// traversals' own box tests (kBoxSlack), so that none of their misses is overlooked.
constexpr double kSlack = 1 + 1e-12, kHitSlack = 1 + 1e-6;

/// Interval of a ray.
struct Interval {
    double begin, end;
};

/// Clips the interval to one slab.
void cut(Interval& part, double lower, double upper, double origin, double speed) {
    if (speed == 0) {
        if (origin < lower || origin > upper) part.end = -1;
        return;
    }
    const double first = (lower - origin) / speed, last = (upper - origin) / speed;
    part.begin = std::max(part.begin, std::min(first, last));
    part.end = std::min(part.end, std::max(first, last));
}

} // namespace

DoubtfulHits::DoubtfulHits(const Mesh& mesh) : mesh_(mesh), triangles_(list_triangles(mesh)) {}

bool DoubtfulHits::is_doubtful(const Ray& ray, const TreeHit& hit) const {
    if (hit.primitive == kNoIndex) return false;
    const std::array<uint32_t, 3>& corners = triangles_.at(hit.primitive);
    Interval part{ray.t_min, ray.t_max};
    const auto cut_axis = [&](float Vec3f::*axis) {
        const auto at = [&](size_t corner) { return mesh_.positions[corners[corner]].*axis; };
        const auto [lower, upper] = std::minmax({at(0), at(1), at(2)});
        cut(part, lower, upper, ray.origin.*axis, ray.direction.*axis);
    };
    cut_axis(&Vec3f::x), cut_axis(&Vec3f::y), cut_axis(&Vec3f::z);
    return part.begin > part.end * kSlack || part.begin > double(hit.t) * kHitSlack;
}

} // namespace relief::bench
