// Watertight for bounced rays: from points of a closed displaced body inwards every ray hits, also in bodies
// a thousand times as long as wide and with directions of any length. RELIEF_LEAK_RAYS sets how many rays in
// all.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <iterator>
#include <ostream>

#include "base/parallel.h"
#include "cpu/leak_rays.h"
#include "cpu/tracer.h"
#include "support/bodies.h"
#include "support/exact_hits.h"

namespace relief {
namespace {

constexpr uint64_t kRaysPerBatch = 1024;
constexpr int kBounces = 3;

struct BounceCase {
    const char* name;
    Vec3f size;
    uint32_t faces; ///< per side of the cube
    DisplacementSpace space;
    int level;
    /// Whether its points are so far from the origin along one axis that their errors show along another.
    bool is_long = false;
};

void PrintTo(const BounceCase& c, std::ostream* stream) { *stream << c.name; }

const BounceCase kBounceCases[] = {
    {"cube_tangent_level4", {1, 1, 1}, 1, DisplacementSpace::tangent, 4},
    {"long_cube_tangent_level4", {1, 1000, 1}, 1, DisplacementSpace::tangent, 4, true},
    {"long_cube_object_level5", {1000, 1, 1}, 1, DisplacementSpace::object, 5, true},
    {"flat_cube_object_level5", {1000, 1, 1000}, 1, DisplacementSpace::object, 5, true},
    {"sphere_tangent_auto", {1, 1, 1}, 4, DisplacementSpace::tangent, kAutoLevel},
    {"long_sphere_object_auto", {1, 1, 1000}, 4, DisplacementSpace::object, kAutoLevel, true},
};

Scene make_scene(const BounceCase& c) {
    Mesh mesh = test::make_cube_sphere(c.faces);
    for (Vec3f& p : mesh.positions) p = p * c.size;
    return test::make_body_scene(std::move(mesh),
                                 test::make_displacement(test::make_random_map(96, 64, 0.06f, 21), c.space));
}

/// Misses: `leaks` of them went through a hole, the others started outside.
struct Misses {
    std::atomic<uint64_t> leaks{0}, outside{0};
};

class BounceLeaks {
  public:
    BounceLeaks(const BounceCase& c, const RenderSettings& settings)
        : size_(c.size),
          prepared_(prepare_scene(make_scene(c), settings)),
          tracer_(prepared_, settings),
          exact_(*prepared_) {}

    void trace_batch(uint64_t batch, Misses& misses) const {
        test::LeakRandom random{batch * 0x9e3779b97f4a7c15ull + 1};
        std::vector<cpu::TraceRay> rays(kRaysPerBatch);
        std::vector<cpu::TraceHit> hits(kRaysPerBatch);
        for (cpu::TraceRay& ray : rays) {
            ray.origin = random.direction() * (0.2f * random.uniform()) * size_;
            ray.direction = random.direction() * size_ * choose_length(random);
        }
        for (int bounce = 0; bounce <= kBounces; ++bounce) {
            tracer_.closest_hits(rays, hits);
            size_t count = 0;
            for (size_t k = 0; k < rays.size(); ++k)
                if (!hits[k].is_hit())
                    count_miss(rays[k], batch, bounce, misses);
                else
                    rays[count++] = bounce_off(rays[k], hits[k], random);
            rays.resize(count), hits.resize(count);
        }
    }

  private:
    static float choose_length(test::LeakRandom& random) {
        constexpr float kLengths[] = {1, 1, 1e12f, 1e-12f};
        return kLengths[size_t(4 * random.uniform()) & 3];
    }

    cpu::TraceRay bounce_off(const cpu::TraceRay& ray, const cpu::TraceHit& hit,
                             test::LeakRandom& random) const {
        const cpu::SurfacePoint point = tracer_.make_surface_point(hit);
        const bool is_behind = dot(point.geometric_normal, ray.direction) > 0;
        const Vec3f inside = is_behind ? -point.geometric_normal : point.geometric_normal;
        Vec3f direction = random.direction();
        if (dot(direction, inside) < 0) direction = -direction;
        return {tracer_.offset_origin(point, direction), 0, direction * choose_length(random)};
    }

    void count_miss(const cpu::TraceRay& ray, uint64_t batch, int bounce, Misses& misses) const {
        if (!exact_.hits(ray)) {
            ++misses.outside;
            return;
        }
        if (misses.leaks++ < 5) ADD_FAILURE() << "batch " << batch << " bounce " << bounce;
    }

    Vec3f size_;
    std::shared_ptr<const PreparedScene> prepared_;
    cpu::Tracer tracer_;
    test::ExactScene exact_;
};

class BounceLeakTest : public testing::TestWithParam<BounceCase> {};

TEST_P(BounceLeakTest, every_ray_from_the_inner_side_hits) {
    RenderSettings settings;
    settings.surface.level = GetParam().level;
    settings.image.height = 96, settings.surface.pixel_error = 12;
    const BounceLeaks body(GetParam(), settings);
    constexpr uint64_t kRaysOfAll = kRaysPerBatch * (kBounces + 1) * std::size(kBounceCases);
    const uint64_t batches = (test::leak_ray_count() + kRaysOfAll - 1) / kRaysOfAll;
    Misses misses;
    parallel_for("bounce leaks", batches, 1, [&](size_t begin, size_t end) {
        for (size_t batch = begin; batch < end; ++batch) body.trace_batch(batch, misses);
    });
    EXPECT_EQ(misses.leaks, 0u);
    // Origins lie as far off a triangle as its points may be wrong: next to a crease that may be outside.
    const uint64_t rays = batches * kRaysPerBatch * (kBounces + 1);
    EXPECT_LE(misses.outside, rays / (GetParam().is_long ? 1000 : 100000));
    RecordProperty("rays", std::to_string(rays));
    RecordProperty("outside", std::to_string(misses.outside));
}

INSTANTIATE_TEST_SUITE_P(Bodies, BounceLeakTest, testing::ValuesIn(kBounceCases),
                         [](const testing::TestParamInfo<BounceCase>& info) {
                             return std::string(info.param.name);
                         });

} // namespace
} // namespace relief
