#include "bench/embree_scene.h"

#include <chrono>
#include <cstring>

#include <embree3/rtcore.h>

#include "relief/error.h"

namespace relief::bench {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

RTCRayHit make_ray_hit(const Ray& ray) {
    RTCRayHit result{};
    result.ray.org_x = ray.origin.x, result.ray.org_y = ray.origin.y, result.ray.org_z = ray.origin.z;
    result.ray.dir_x = ray.direction.x, result.ray.dir_y = ray.direction.y,
    result.ray.dir_z = ray.direction.z;
    result.ray.tnear = ray.t_min, result.ray.tfar = ray.t_max;
    result.ray.mask = 0xffffffffu;
    result.hit.geomID = result.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return result;
}

} // namespace

struct EmbreeScene::Implementation {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    double build_s = 0;

    ~Implementation() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }

    void add_geometry(const Mesh& mesh) const {
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                 sizeof(Vec3f), mesh.positions.size());
        void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                3 * sizeof(uint32_t), mesh.face_sizes.size());
        if (vertices && indices) {
            std::memcpy(vertices, mesh.positions.data(), mesh.positions.size() * sizeof(Vec3f));
            std::memcpy(indices, mesh.position_indices.data(),
                        mesh.position_indices.size() * sizeof(uint32_t));
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
    }
};

EmbreeScene::EmbreeScene(const Mesh& mesh, EmbreeMode mode)
    : implementation_(std::make_unique<Implementation>()) {
    Implementation& self = *implementation_;
    self.device = rtcNewDevice("threads=1");
    if (!self.device) throw Error(ErrorKind::failed, {"Embree makes no device", "", ""});
    self.scene = rtcNewScene(self.device);
    rtcSetSceneBuildQuality(self.scene, RTC_BUILD_QUALITY_MEDIUM);
    if (mode == EmbreeMode::robust) rtcSetSceneFlags(self.scene, RTC_SCENE_FLAG_ROBUST);
    self.add_geometry(mesh);
    const Clock::time_point start = Clock::now();
    rtcCommitScene(self.scene);
    self.build_s = seconds_since(start);
    if (rtcGetDeviceError(self.device) != RTC_ERROR_NONE)
        throw Error(ErrorKind::failed, {"Embree cannot build its tree", mesh.name, ""});
}

EmbreeScene::~EmbreeScene() = default;

double EmbreeScene::build_s() const { return implementation_->build_s; }

EmbreeRun EmbreeScene::trace(std::span<const Ray> rays) const {
    std::vector<RTCRayHit> traced;
    traced.reserve(rays.size());
    for (const Ray& ray : rays) traced.push_back(make_ray_hit(ray));
    EmbreeRun run;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    const Clock::time_point start = Clock::now();
    for (RTCRayHit& ray : traced) rtcIntersect1(implementation_->scene, &context, &ray);
    run.seconds = seconds_since(start);
    for (const RTCRayHit& ray : traced) {
        const bool is_hit = ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        run.hits.push_back(is_hit ? TriangleHit{ray.ray.tfar, ray.hit.primID} : TriangleHit{});
        run.normals.push_back({ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z});
    }
    return run;
}

} // namespace relief::bench
