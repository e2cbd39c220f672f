// The kernels that trace rays for one instruction set, RELIEF_TARGET: each has a source of its own
// (cmake/Kernels.cmake), so that processors compile them side by side, and a build may leave some out. The
// headers below are thus compiled for one target and need no guards that Highway can toggle.
#include "math/lane_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cpu/traversal/kernels-inl.h"
#include <hwy/foreach_target.h>

#if HWY_TARGET == RELIEF_TARGET

#include "cpu/traversal/bundle_traversal-inl.h"
#include "cpu/traversal/kernels.h"
#include "cpu/traversal/patch_list-inl.h"
#include "engine/finite_ray.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {
namespace {

/// Of the angle between two rays of a packet: 60 degrees.
constexpr float kLeastSquaredCosine = 0.25f;

/// Sixteen rays that can hit and have the requested LOD bias, with directions near the first one.
bool is_coherent(const RayLanes& rays, const Vec3f& first) {
    const Lanes16(&d)[3] = rays.direction;
    const Lanes16 projection = dot_lanes(d, first), least(kLeastSquaredCosine * dot(first, first));
    const LaneMask is_near =
        less(Lanes16(0.0f), projection) &
        less_equal(least * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), projection * projection);
    return (is_near & rays.of_lod_bias & rays.can_hit()) == 0xffff;
}

/// A look at some of the rays, which spares most of those that go different ways the way into lanes.
bool may_be_coherent(const cpu::TraceRay* rays) {
    const Vec3f& first = rays[0].direction;
    const float least = kLeastSquaredCosine * dot(first, first);
    for (int k = 15; k > 0; k -= 5) {
        const Vec3f& other = rays[k].direction;
        const float projection = dot(first, other);
        if (!(projection > 0 && projection * projection >= least * dot(other, other))) return false;
    }
    return true;
}

template <Query kQuery, class Store>
void trace_rays(const cpu::SceneView& scene, cpu::TraceContext& context, const cpu::TraceRay* rays,
                size_t count, Store store) {
    for (size_t begin = 0; begin < count; begin += 16) {
        scene.cache->refresh(context);
        const cpu::TraceRay* const world = rays + begin;
        const size_t size = HWY_MIN(size_t(16), count - begin);
        if (size == 16 && scene.lod == LodRule::field && may_be_coherent(world)) {
            const RayLanes lanes(world, 16, world[0].lod_bias);
            if (is_coherent(lanes, world[0].direction)) {
                Packet packet;
                const LaneMask occluded = trace_packet<kQuery>(scene, context, world, lanes, packet);
                for (size_t k = 0; k < 16; ++k) store(begin + k, packet.ray[k].hit, (occluded >> k & 1) != 0);
                continue;
            }
        }
        for (size_t k = 0; k < size; ++k) {
            RayState ray;
            const bool has_hit = can_hit(world[k]) && trace_ray<kQuery>(scene, context, world[k], ray);
            store(begin + k, ray.hit, has_hit);
        }
    }
}

bool may_trace_bundles(const cpu::SceneView& scene) {
    return scene.lod == LodRule::field && scene.leaf == LeafKind::exact;
}

/// Hits of the rays at the front with one origin, or else of about one direction; returns how many.
size_t trace_front(const cpu::SceneView& scene, cpu::TraceContext& context, const cpu::TraceRay* rays,
                   cpu::TraceHit* hits, size_t count) {
    if (count < kLeastBundle || !may_trace_bundles(scene)) return 0;
    BundleRays bundle;
    load_frustum(rays, count, bundle);
    if (bundle.count >= kLeastBundle) {
        pad_inactive_lanes(bundle);
        scene.cache->refresh(context);
        return trace_bundle<RayFrustum>(scene, context, bundle, hits) ? bundle.count : 0;
    }
    if (!may_be_coherent(rays)) return 0;
    load_beam(rays, count, bundle);
    if (bundle.count < kLeastBundle) return 0;
    pad_inactive_lanes(bundle);
    if (!are_neighbours_close(bundle, scene.narrow)) return 0;
    scene.cache->refresh(context);
    return trace_bundle<ParallelBeam>(scene, context, bundle, hits) ? bundle.count : 0;
}

/// Nearest hits of rays that are no bundle.
void trace_others(const cpu::SceneView& scene, cpu::TraceContext& context, const cpu::TraceRay* rays,
                  cpu::TraceHit* hits, size_t count) {
    trace_rays<Query::closest>(scene, context, rays, count, [&](size_t k, const cpu::TraceHit& hit, bool) {
        hits[k] = hit;
        hits[k].lod_bias = uint8_t(rays[k].lod_bias);
    });
}

void closest_hits(const cpu::SceneView& scene, cpu::TraceContext& context, const cpu::TraceRay* rays,
                  cpu::TraceHit* hits, size_t count) {
    for (size_t begin = 0; begin < count;) {
        size_t size = trace_front(scene, context, rays + begin, hits + begin, count - begin);
        if (size == 0) {
            size = HWY_MIN(size_t(kBundleSize), count - begin);
            trace_others(scene, context, rays + begin, hits + begin, size);
        }
        begin += size;
    }
}

void camera_hits(const cpu::SceneView& scene, cpu::TraceContext& context, const cpu::CameraPixels& pixels,
                 cpu::TraceRay* rays, cpu::TraceHit* hits) {
    for (size_t begin = 0; begin < pixels.count; begin += kBundleSize) {
        const uint32_t size = uint32_t(HWY_MIN(size_t(kBundleSize), pixels.count - begin));
        BundleRays bundle;
        load_frustum(pixels.camera, pixels.positions + begin, size, rays ? rays + begin : nullptr, bundle);
        pad_inactive_lanes(bundle);
        scene.cache->refresh(context);
        // make_pinhole_ray leaves nothing infinite in a direction; the origin is the same for all.
        const bool may_be_bundle = size >= kLeastBundle && may_trace_bundles(scene) &&
                                   relief::can_hit(cpu::TraceRay{bundle.origin, 0, bundle.direction_of(0)});
        if (may_be_bundle && trace_bundle<RayFrustum>(scene, context, bundle, hits + begin)) continue;
        cpu::TraceRay aimed[kBundleSize];
        for (uint32_t k = 0; k < size; ++k)
            aimed[k].origin = bundle.origin, aimed[k].direction = bundle.direction_of(k);
        trace_others(scene, context, aimed, hits + begin, size);
    }
}

void any_hits(const cpu::SceneView& scene, cpu::TraceContext& context, const cpu::TraceRay* rays,
              uint8_t* occluded, size_t count) {
    trace_rays<Query::any>(scene, context, rays, count,
                           [&](size_t k, const cpu::TraceHit&, bool has_hit) { occluded[k] = has_hit; });
}

template <Query kQuery>
bool visit_primitive(const cpu::SceneView& scene, cpu::TraceContext& context, const cpu::TraceRay& world,
                     uint32_t instance, uint32_t patch, cpu::TraceHit& best) {
    RayState ray;
    ray.t_min = world.t_min, ray.t_max = std::fmin(world.t_max, best.t);
    ray.instance = instance;
    ray.hit = best;
    enter_object(world, scene.instances[instance], ray);
    const bool has_hit = trace_primitive<kQuery>(scene, context, world, patch, ray);
    best = ray.hit;
    return has_hit;
}

void evaluate_cells(const Surface& surface, const cpu::PatchCells& cells, Vec3f* vertices, size_t stride) {
    VertexGrid grid;
    evaluate_tile(surface, {cells.patch, cells.levels, cells.cell_x, cells.cell_y, cells.cell_count}, grid);
    for (size_t r = 0; r <= cells.cell_count; ++r)
        for (size_t c = 0; c <= cells.cell_count; ++c) {
            const size_t slot = r * VertexGrid::kPitch + c;
            vertices[r * stride + c] = {grid.axis[0][slot], grid.axis[1][slot], grid.axis[2][slot]};
        }
}

} // namespace

const cpu::Kernels& kernels(const char* name) {
    static const cpu::Kernels kKernels{
        name,     closest_hits,   camera_hits,
        any_hits, list_patches,   build_tree,
        find_box, evaluate_cells, {visit_primitive<Query::closest>, visit_primitive<Query::any>}};
    return kKernels;
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
