#include "relief/intersect.h"

#include <fmt/format.h>

#include <utility>

#include "api/make_engine.h"
#include "base/parallel.h"
#include "prepare/validate_settings.h"
#include "relief/error.h"

namespace relief {

namespace {

void require_equal(size_t rays, size_t hits) {
    if (rays != hits)
        throw Error(ErrorKind::usage, {fmt::format("{} rays but room for {} hits", rays, hits), "",
                                       "give spans of equal length"});
}

} // namespace

struct Intersector::Implementation {
    std::unique_ptr<Engine> engine;
    int threads = 0;
};

Intersector::Intersector(Scene scene, const RenderSettings& settings)
    : implementation_(std::make_unique<Implementation>()) {
    validate_settings(settings);
    implementation_->threads = settings.device.threads;
    with_threads(settings.device.threads, [&] {
        implementation_->engine = make_engine(prepare_scene(std::move(scene), settings), settings);
    });
}

Intersector::~Intersector() = default;
Intersector::Intersector(Intersector&&) noexcept = default;
Intersector& Intersector::operator=(Intersector&&) noexcept = default;

void Intersector::closest_hits(std::span<const Ray> rays, std::span<RayHit> hits) const {
    require_equal(rays.size(), hits.size());
    with_threads(implementation_->threads, [&] { implementation_->engine->closest_hits(rays, hits); });
}

void Intersector::any_hits(std::span<const Ray> rays, std::span<uint8_t> hits) const {
    require_equal(rays.size(), hits.size());
    with_threads(implementation_->threads, [&] { implementation_->engine->any_hits(rays, hits); });
}

} // namespace relief
