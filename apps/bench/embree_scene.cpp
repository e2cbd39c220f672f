#include "bench/embree_scene.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>
#include <utility>

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include "bench/embree_geometry.h"
#include "bench/thread_loop.h"
#include "relief/error.h"

namespace relief::bench {

namespace {

using Clock = std::chrono::steady_clock;

constexpr size_t kBatchSize = 1024; ///< rays per task, as in Relief

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

bool count_bytes(void* total, ssize_t bytes, bool) {
    static_cast<std::atomic<int64_t>*>(total)->fetch_add(bytes);
    return true;
}

void set_ray(RTCRay& to, const Ray& ray) {
    to.org_x = ray.origin.x, to.org_y = ray.origin.y, to.org_z = ray.origin.z;
    to.dir_x = ray.direction.x, to.dir_y = ray.direction.y, to.dir_z = ray.direction.z;
    to.tnear = ray.t_min, to.tfar = ray.t_max;
    to.time = 0, to.mask = 0xffffffffu, to.id = 0, to.flags = 0;
}

template <class Packet> void set_ray(Packet& to, size_t lane, const Ray& ray) {
    to.org_x[lane] = ray.origin.x, to.org_y[lane] = ray.origin.y, to.org_z[lane] = ray.origin.z;
    to.dir_x[lane] = ray.direction.x, to.dir_y[lane] = ray.direction.y, to.dir_z[lane] = ray.direction.z;
    to.tnear[lane] = ray.t_min, to.tfar[lane] = ray.t_max;
    to.time[lane] = 0, to.mask[lane] = 0xffffffffu, to.id[lane] = 0, to.flags[lane] = 0;
}

/// A span of rays in progress, shared by the loops below.
struct Cast {
    RTCScene scene;
    RTCIntersectContext* context;
    const Ray* rays;
    uint32_t displaced_count; ///< primitives of geometry 0

    TreeHit make_hit(float t, uint32_t geometry, uint32_t primitive) const {
        if (geometry == RTC_INVALID_GEOMETRY_ID) return {};
        return {t, primitive + (geometry == 0 ? 0 : displaced_count)};
    }
};

void intersect_single(const Cast& cast, size_t begin, size_t end, TreeHit* hits) {
    for (size_t k = begin; k < end; ++k) {
        RTCRayHit ray;
        set_ray(ray.ray, cast.rays[k]);
        ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(cast.scene, cast.context, &ray);
        hits[k] = cast.make_hit(ray.ray.tfar, ray.hit.geomID, ray.hit.primID);
    }
}

void occlude_single(const Cast& cast, size_t begin, size_t end, uint8_t* occluded) {
    for (size_t k = begin; k < end; ++k) {
        RTCRay ray;
        set_ray(ray, cast.rays[k]);
        rtcOccluded1(cast.scene, cast.context, &ray);
        occluded[k] = ray.tfar < 0;
    }
}

template <size_t kWidth, class Packet, class Call>
void intersect_packets(const Cast& cast, size_t begin, size_t end, TreeHit* hits, Call call) {
    for (size_t first = begin; first < end; first += kWidth) {
        alignas(64) int valid[kWidth];
        alignas(64) Packet packet;
        for (size_t lane = 0; lane < kWidth; ++lane) {
            valid[lane] = first + lane < end ? -1 : 0;
            set_ray(packet.ray, lane, cast.rays[std::min(first + lane, end - 1)]);
            packet.hit.geomID[lane] = packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
        }
        call(valid, cast.scene, cast.context, &packet);
        for (size_t lane = 0; lane < kWidth && first + lane < end; ++lane)
            hits[first + lane] =
                cast.make_hit(packet.ray.tfar[lane], packet.hit.geomID[lane], packet.hit.primID[lane]);
    }
}

template <size_t kWidth, class Packet, class Call>
void occlude_packets(const Cast& cast, size_t begin, size_t end, uint8_t* occluded, Call call) {
    for (size_t first = begin; first < end; first += kWidth) {
        alignas(64) int valid[kWidth];
        alignas(64) Packet packet;
        for (size_t lane = 0; lane < kWidth; ++lane) {
            valid[lane] = first + lane < end ? -1 : 0;
            set_ray(packet, lane, cast.rays[std::min(first + lane, end - 1)]);
        }
        call(valid, cast.scene, cast.context, &packet);
        for (size_t lane = 0; lane < kWidth && first + lane < end; ++lane)
            occluded[first + lane] = packet.tfar[lane] < 0;
    }
}

void intersect(const Cast& cast, int width, size_t begin, size_t end, TreeHit* hits) {
    if (width == 16)
        intersect_packets<16, RTCRayHit16>(cast, begin, end, hits, rtcIntersect16);
    else if (width == 8)
        intersect_packets<8, RTCRayHit8>(cast, begin, end, hits, rtcIntersect8);
    else
        intersect_single(cast, begin, end, hits);
}

void occlude(const Cast& cast, int width, size_t begin, size_t end, uint8_t* occluded) {
    if (width == 16)
        occlude_packets<16, RTCRay16>(cast, begin, end, occluded, rtcOccluded16);
    else if (width == 8)
        occlude_packets<8, RTCRay8>(cast, begin, end, occluded, rtcOccluded8);
    else
        occlude_single(cast, begin, end, occluded);
}

uint64_t take_serial() {
    static std::atomic<uint64_t> next{1};
    return next++;
}

} // namespace

std::string embree_version() {
    RTCDevice device = rtcNewDevice(nullptr);
    const auto version = int(rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_VERSION));
    rtcReleaseDevice(device);
    return fmt::format("{}.{}.{}", version / 10000, version / 100 % 100, version % 100);
}

struct EmbreeScene::Implementation {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    int threads = 1;
    double tessellate_s = 0, build_s = 0;
    std::atomic<int64_t> bytes{0};
    EmbreeTriangles displaced, plain;
    DisplacedPatches patches;

    explicit Implementation(int thread_count) : threads(thread_count) {
        device = rtcNewDevice(fmt::format("threads={},hugepages=1", threads).c_str());
        if (!device) throw Error(ErrorKind::failed, {"Embree makes no device", "", ""});
        rtcSetDeviceMemoryMonitorFunction(device, count_bytes, &bytes);
        scene = rtcNewScene(device);
        rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    }
    ~Implementation() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }

    void attach(RTCGeometry geometry) const {
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
    }

    void add_patches(EmbreeWay way) {
        if (patches.probe->patch_count() == 0) return;
        if (way == EmbreeWay::triangles)
            attach(make_micro_triangles(device, *patches.probe, threads, displaced));
        else if (way == EmbreeWay::grid)
            attach(make_grids(device, *patches.probe, threads));
        else
            attach(make_subdivision(device, patches));
    }

    void build(const std::string& name) {
        const Clock::time_point start = Clock::now();
        rtcCommitScene(scene);
        build_s = seconds_since(start);
        if (rtcGetDeviceError(device) != RTC_ERROR_NONE)
            throw Error(ErrorKind::failed, {"Embree cannot build its tree", name, ""});
    }
};

EmbreeScene::EmbreeScene(const Mesh& mesh, EmbreeMode mode)
    : implementation_(std::make_unique<Implementation>(1)) {
    Implementation& self = *implementation_;
    if (mode == EmbreeMode::robust) rtcSetSceneFlags(self.scene, RTC_SCENE_FLAG_ROBUST);
    self.attach(make_triangle_geometry(self.device, mesh, self.displaced));
    self.build(mesh.name);
}

EmbreeScene::EmbreeScene(const TracerProbe& probe, EmbreeWay way, int threads)
    : implementation_(std::make_unique<Implementation>(threads)) {
    Implementation& self = *implementation_;
    self.patches = {&probe, take_serial()};
    const Clock::time_point start = Clock::now();
    self.add_patches(way);
    if (RTCGeometry plain = make_plain_geometry(self.device, probe, self.plain)) self.attach(plain);
    self.tessellate_s = seconds_since(start);
    self.build("");
}

EmbreeScene::~EmbreeScene() = default;
EmbreeScene::EmbreeScene(EmbreeScene&&) noexcept = default;
EmbreeScene& EmbreeScene::operator=(EmbreeScene&&) noexcept = default;

double EmbreeScene::tessellate_s() const { return implementation_->tessellate_s; }
double EmbreeScene::build_s() const { return implementation_->build_s; }
uint64_t EmbreeScene::byte_count() const { return uint64_t(implementation_->bytes.load()); }

EmbreeRun EmbreeScene::trace(std::span<const Ray> rays, const EmbreeQuery& query, EmbreeRun room) const {
    const Implementation& self = *implementation_;
    const bool is_any = query.kind == HitKind::any;
    EmbreeRun run = std::move(room);
    run.hit_count = 0;
    run.hits.resize(is_any ? 0 : rays.size());
    run.occluded.resize(is_any ? rays.size() : 0);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags =
        query.is_coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    const Cast cast{self.scene, &context, rays.data(), self.displaced.count};
    const Clock::time_point start = Clock::now();
    run_in_ranges(query.threads > 0 ? query.threads : self.threads, rays.size(), kBatchSize,
                  [&](size_t begin, size_t end) {
                      if (is_any)
                          occlude(cast, query.width, begin, end, run.occluded.data());
                      else
                          intersect(cast, query.width, begin, end, run.hits.data());
                  });
    run.seconds = seconds_since(start);
    for (const TreeHit& hit : run.hits) run.hit_count += hit.primitive != kNoIndex ? 1 : 0;
    for (const uint8_t occluded : run.occluded) run.hit_count += occluded;
    return run;
}

std::array<Vec3f, 3> EmbreeScene::find_corners(uint32_t primitive) const {
    const Implementation& self = *implementation_;
    const bool is_displaced = primitive < self.displaced.count;
    const EmbreeTriangles& triangles = is_displaced ? self.displaced : self.plain;
    const uint32_t* index =
        triangles.indices + 3 * size_t(is_displaced ? primitive : primitive - self.displaced.count);
    return {triangles.vertices[index[0]], triangles.vertices[index[1]], triangles.vertices[index[2]]};
}

} // namespace relief::bench
