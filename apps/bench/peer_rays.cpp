#include "bench/peer_rays.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bench/tree_rays.h"
#include "common/vectors.h"
#include "relief/error.h"

namespace relief::bench {

namespace {

constexpr float kLensRadius = 0.01f; ///< relative to the focus distance

/// Unit vector towards the sun: high, from the left.
constexpr Vec3f kToSun{-0.48f, 0.64f, 0.6f};

/// First random number of each set of rays; the sets share none.
constexpr uint32_t kOcclusionNumbers = 0x40000000u, kBounceNumbers = 0x04000000u;

using vectors::dot;

Camera make_lens_camera(Camera camera) {
    const Vec3f to{camera.to.x - camera.from.x, camera.to.y - camera.from.y, camera.to.z - camera.from.z};
    camera.focus_distance = std::sqrt(dot(to, to));
    camera.aperture_radius = kLensRadius * camera.focus_distance;
    return camera;
}

Camera make_pinhole_camera(Camera camera) {
    camera.aperture_radius = 0;
    return camera;
}

/// The point with its normal on the ray's side.
ProbePoint find_seen_point(const TracerProbe& probe, const ProbeHit& hit, const Ray& ray) {
    ProbePoint point = probe.find_point(hit);
    if (dot(point.normal, ray.direction) > 0)
        point.normal = {-point.normal.x, -point.normal.y, -point.normal.z};
    return point;
}

PeerRays make_sun_rays(const TracerProbe& probe, const PeerRays& from, const std::vector<ProbeHit>& hits) {
    PeerRays set{"sun", HitKind::any, true, {}};
    for (size_t k = 0; k < hits.size(); ++k) {
        if (!hits[k].is_hit()) continue;
        const ProbePoint point = find_seen_point(probe, hits[k], from.rays[k]);
        if (dot(point.normal, kToSun) > 0) set.rays.push_back(probe.leave(point, kToSun));
    }
    return set;
}

/// `first_number`: first random number of the directions.
void add_cosine_rays(const TracerProbe& probe, const PeerRays& from, const std::vector<ProbeHit>& hits,
                     uint32_t first_number, PeerRays& set) {
    for (size_t k = 0; k < hits.size(); ++k) {
        if (!hits[k].is_hit()) continue;
        const ProbePoint point = find_seen_point(probe, hits[k], from.rays[k]);
        const Vec3f direction = draw_cosine_direction(point.normal, first_number + uint32_t(k));
        if (dot(point.normal, direction) > 0) set.rays.push_back(probe.leave(point, direction));
    }
}

} // namespace

std::vector<PeerRays> make_peer_rays(const TracerProbe& probe, const Camera& camera) {
    const auto trace = [&](const PeerRays& set) {
        return probe.trace(set.rays, HitKind::closest, RayGrouping::packets).hits;
    };
    std::vector<PeerRays> sets = {
        {"primary", HitKind::closest, true, probe.make_camera_rays(make_pinhole_camera(camera))},
        {"lens", HitKind::closest, true, probe.make_camera_rays(make_lens_camera(camera))}};
    const PeerRays primary = sets.front();
    std::vector<ProbeHit> hits = trace(primary);
    sets.push_back(make_sun_rays(probe, primary, hits));
    sets.push_back({"occlusion", HitKind::any, false, {}});
    add_cosine_rays(probe, primary, hits, kOcclusionNumbers, sets.back());
    for (int bounce = 1; bounce <= kPeerBounces; ++bounce) {
        const PeerRays& from = bounce == 1 ? primary : sets.back();
        PeerRays set{fmt::format("diffuse_{}", bounce), HitKind::closest, false, {}};
        add_cosine_rays(probe, from, hits, uint32_t(bounce) * kBounceNumbers, set);
        hits = trace(set);
        sets.push_back(std::move(set));
    }
    return sets;
}

const PeerRays& find_rays(const std::vector<PeerRays>& sets, const std::string& name) {
    const auto found =
        std::find_if(sets.begin(), sets.end(), [&](const PeerRays& set) { return set.name == name; });
    if (found == sets.end()) throw Error(ErrorKind::usage, {"no rays of that name", name, ""});
    return *found;
}

} // namespace relief::bench
