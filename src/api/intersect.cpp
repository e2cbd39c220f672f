#include "relief/intersect.h"

#include <fmt/format.h>

#include <utility>

#include "api/hit_attributes.h"
#include "api/make_engine.h"
#include "base/parallel.h"
#include "prepare/validate_settings.h"
#include "relief/error.h"

namespace relief {

namespace {

void require_equal(size_t rays, const char* what, size_t count) {
    if (rays != count)
        throw Error(ErrorKind::usage, {fmt::format("{} rays but room for {} {}", rays, count, what), "",
                                       "give spans of equal length"});
}

} // namespace

struct Intersector::Implementation {
    std::shared_ptr<const PreparedScene> scene;
    std::unique_ptr<Engine> engine;
    int threads = 0;
};

Intersector::Intersector(Scene scene, const IntersectorSettings& given)
    : implementation_(std::make_unique<Implementation>()) {
    RenderSettings settings{given.surface, given.device, {}, given.experiment};
    settings.image.height = given.picture_height;
    validate_settings(settings);
    implementation_->threads = settings.device.threads;
    with_threads(settings.device.threads, [&] {
        implementation_->scene = prepare_scene(std::move(scene), settings);
        implementation_->engine = make_engine(implementation_->scene, settings);
    });
}

Intersector::~Intersector() = default;
Intersector::Intersector(Intersector&&) noexcept = default;
Intersector& Intersector::operator=(Intersector&&) noexcept = default;

void Intersector::closest_hits(std::span<const Ray> rays, std::span<RayHit> hits, const RayQuery& query,
                               std::span<HitAttributes> attributes) const {
    require_equal(rays.size(), "hits", hits.size());
    require_equal(query.attributes ? rays.size() : 0, "attributes", attributes.size());
    with_threads(implementation_->threads, [&] {
        implementation_->engine->closest_hits(rays, hits, query.visibility_mask);
        if (query.attributes)
            compute_hit_attributes(*implementation_->scene, query.attributes, hits, attributes);
    });
}

void Intersector::any_hits(std::span<const Ray> rays, std::span<uint8_t> hits,
                           uint32_t visibility_mask) const {
    require_equal(rays.size(), "hits", hits.size());
    with_threads(implementation_->threads,
                 [&] { implementation_->engine->any_hits(rays, hits, visibility_mask); });
}

RayHit Intersector::closest_hit(const Ray& ray, uint32_t visibility_mask) const {
    RayHit hit;
    with_threads(1, [&] { implementation_->engine->closest_hits({&ray, 1}, {&hit, 1}, visibility_mask); });
    return hit;
}

bool Intersector::any_hit(const Ray& ray, uint32_t visibility_mask) const {
    uint8_t is_hit = 0;
    with_threads(1, [&] { implementation_->engine->any_hits({&ray, 1}, {&is_hit, 1}, visibility_mask); });
    return is_hit != 0;
}

const std::vector<std::string>& Intersector::warnings() const { return implementation_->scene->warnings; }

} // namespace relief
