#include "bench/peer_agreement.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "bench/peers.h"
#include "relief/error.h"

namespace relief::bench {

namespace {

/// `kShortest`: minimum reference distance, as a fraction of the largest coordinate of the ray's origin.
constexpr double kSameDepth = 1e-5, kShortest = 0.1, kEdge = 1e-6, kTolerableShare = 1e-3;
constexpr uint64_t kTolerableCount = 8;

struct Point {
    double x, y, z;
};

Point subtract(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double length(const Point& a) { return std::sqrt(dot(a, a)); }
Point widen(const Vec3f& a) { return {a.x, a.y, a.z}; }
double largest(const Vec3f& a) { return std::max({std::fabs(a.x), std::fabs(a.y), std::fabs(a.z)}); }

/// Distance between the line of a ray and the segment from `a` to `b`.
double compute_distance(const Point& origin, const Point& direction, const Point& a, const Point& b) {
    // In the plane perpendicular to the ray.
    const double square = dot(direction, direction);
    const auto flatten = [&](const Point& p) {
        const Point to = subtract(p, origin);
        const double along = dot(to, direction) / square;
        return Point{to.x - along * direction.x, to.y - along * direction.y, to.z - along * direction.z};
    };
    const Point p = flatten(a), q = flatten(b), edge = subtract(q, p);
    const double edge_square = dot(edge, edge);
    const double s = edge_square > 0 ? std::clamp(-dot(p, edge) / edge_square, 0.0, 1.0) : 0;
    return length({p.x + s * edge.x, p.y + s * edge.y, p.z + s * edge.z});
}

using Corners = std::array<Vec3f, 3>;

bool is_at_edge(const Ray& ray, const Corners& corners) {
    double scale = largest(ray.origin);
    for (const Vec3f& corner : corners) scale = std::max(scale, largest(corner));
    for (size_t k = 0; k < 3; ++k)
        if (compute_distance(widen(ray.origin), widen(ray.direction), widen(corners[k]),
                             widen(corners[(k + 1) % 3])) <= kEdge * scale)
            return true;
    return false;
}

/// Whether the ray's point at `t` lies in the triangle's plane: grazing rays amplify rounding.
bool is_in_plane(const Ray& ray, double t, const Corners& corners) {
    const Point o = widen(ray.origin), d = widen(ray.direction), a = widen(corners[0]);
    const Point u = subtract(widen(corners[1]), a), v = subtract(widen(corners[2]), a);
    const Point normal{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    const Point to = subtract({o.x + t * d.x, o.y + t * d.y, o.z + t * d.z}, a);
    const double scale = std::max(largest(ray.origin), largest(corners[0]));
    return std::fabs(dot(normal, to)) <= kEdge * scale * length(normal);
}

/// Distances of all rays, and a look-up of the triangle of a hit, if known.
struct Answers {
    std::vector<float> depths;
    std::function<Corners(size_t)> find_corners;
};

/// Counts differences of closest-hit rays.
void compare(std::span<const Ray> rays, const Answers& relief, const Answers& other, Agreement& result) {
    for (size_t k = 0; k < rays.size(); ++k) {
        const double a = relief.depths[k], b = other.depths[k];
        const bool has_a = std::isfinite(a), has_b = std::isfinite(b);
        if (!has_a && !has_b) continue;
        // Short distances are limited by the rounding of coordinates.
        const double scale = std::max(std::fabs(a), kShortest * largest(rays[k].origin));
        const double relative = has_a && has_b ? std::fabs(a - b) / std::max(scale, 1e-30) : 0;
        if (has_a && has_b && relative <= kSameDepth) {
            result.largest_depth = std::max(result.largest_depth, relative);
            continue;
        }
        ++(!has_a ? result.missed : !has_b ? result.extra : result.depth);
        const Answers& nearer = a < b ? relief : other;
        if (nearer.find_corners && is_at_edge(rays[k], nearer.find_corners(k)))
            ++result.at_edges;
        else if (has_a && has_b && nearer.find_corners &&
                 is_in_plane(rays[k], std::max(a, b), nearer.find_corners(k)))
            ++result.grazing;
        else
            result.largest_depth = std::max(result.largest_depth, relative);
    }
}

Answers find_nearest(const TracerProbe& probe, std::span<const Ray> rays) {
    auto hits = std::make_shared<const std::vector<ProbeHit>>(
        probe.trace(rays, HitKind::closest, RayGrouping::packets).hits);
    Answers answers{{}, [&probe, hits](size_t k) { return probe.find_corners((*hits)[k]); }};
    for (const ProbeHit& hit : *hits) answers.depths.push_back(hit.t);
    return answers;
}

Answers find_nearest(const EmbreeScene& embree, EmbreeWay way, std::span<const Ray> rays) {
    auto hits = std::make_shared<const std::vector<TreeHit>>(embree.trace(rays, {}).hits);
    Answers answers;
    if (way == EmbreeWay::triangles)
        answers.find_corners = [&embree, hits](size_t k) {
            return embree.find_corners((*hits)[k].primitive);
        };
    for (const TreeHit& hit : *hits) answers.depths.push_back(hit.t);
    return answers;
}

/// Any-hit rays with different answers are traced again for the closest hit.
std::vector<Ray> list_disputed(const PeerRays& set, const std::vector<uint8_t>& a,
                               const std::vector<uint8_t>& b) {
    std::vector<Ray> rays;
    for (size_t k = 0; k < a.size(); ++k)
        if (a[k] != b[k]) rays.push_back(set.rays[k]);
    return rays;
}

} // namespace

Agreement compare_with_embree(const TracerProbe& probe, const EmbreeScene& embree, EmbreeWay way,
                              const PeerRays& set) {
    Agreement result;
    result.rays = set.name, result.against = std::string("Embree ") + way_name(way),
    result.count = set.rays.size();
    if (set.kind == HitKind::closest) {
        const Answers own = find_nearest(probe, set.rays);
        result.hits = uint64_t(std::count_if(own.depths.begin(), own.depths.end(),
                                             [](float depth) { return std::isfinite(depth); }));
        compare(set.rays, own, find_nearest(embree, way, set.rays), result);
        return result;
    }
    const ProbeRun own = probe.trace(set.rays, HitKind::any, RayGrouping::packets);
    const EmbreeRun theirs = embree.trace(set.rays, {HitKind::any, 1, false});
    result.hits = own.hit_count;
    const std::vector<Ray> disputed = list_disputed(set, own.occluded, theirs.occluded);
    compare(disputed, find_nearest(probe, disputed), find_nearest(embree, way, disputed), result);
    // The remaining answers contradict the closest hit of the same program.
    result.missed += disputed.size() - std::min<uint64_t>(disputed.size(), result.differences());
    return result;
}

Agreement compare_with_tessellated(const TracerProbe& probe, const TracerProbe& tessellated,
                                   const PeerRays& set) {
    Agreement result;
    result.rays = set.name, result.against = "tessellated", result.count = set.rays.size();
    const Answers own = find_nearest(probe, set.rays);
    result.hits = uint64_t(std::count_if(own.depths.begin(), own.depths.end(),
                                         [](float depth) { return std::isfinite(depth); }));
    compare(set.rays, own, find_nearest(tessellated, set.rays), result);
    return result;
}

void require_agreement(const std::string& scene, const Agreement& agreement) {
    const uint64_t unexplained = agreement.differences() - agreement.at_edges - agreement.grazing;
    if (unexplained <= kTolerableCount || double(unexplained) <= kTolerableShare * double(agreement.hits))
        return;
    throw Error(
        ErrorKind::failed,
        {fmt::format("{} rays, Relief against {}: {} of {} hits differ (missed {}, extra {}, depth {}, at "
                     "edges {}); no times are reported",
                     agreement.rays, agreement.against, agreement.differences(), agreement.hits,
                     agreement.missed, agreement.extra, agreement.depth, agreement.at_edges,
                     agreement.grazing),
         scene, "the programs trace different surfaces: please report this"});
}

Value describe_agreement(const Agreement& a) {
    return {{"rays", a.rays},       {"against", a.against},
            {"count", a.count},     {"hits", a.hits},
            {"missed", a.missed},   {"extra", a.extra},
            {"depth", a.depth},     {"at_edges", a.at_edges},
            {"grazing", a.grazing}, {"largest_relative_depth", a.largest_depth}};
}

} // namespace relief::bench
