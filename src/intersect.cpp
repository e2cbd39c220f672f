#include "relief/intersect.h"

#include <utility>

#include "base/parallel.h"
#include "engine/engine.h"

namespace relief {

struct Intersector::Implementation {
    std::unique_ptr<Engine> engine;
    int threads = 0;
};

Intersector::Intersector(Scene scene, const RenderSettings& settings)
    : implementation_(std::make_unique<Implementation>()) {
    implementation_->threads = settings.threads;
    with_threads(settings.threads, [&] {
        implementation_->engine = make_cpu_engine(prepare_scene(std::move(scene), settings), settings);
    });
}

Intersector::~Intersector() = default;
Intersector::Intersector(Intersector&&) noexcept = default;
Intersector& Intersector::operator=(Intersector&&) noexcept = default;

void Intersector::closest_hits(std::span<const Ray> rays, std::span<RayHit> hits) const {
    with_threads(implementation_->threads, [&] { implementation_->engine->closest_hits(rays, hits); });
}

void Intersector::any_hits(std::span<const Ray> rays, std::span<uint8_t> hits) const {
    with_threads(implementation_->threads, [&] { implementation_->engine->any_hits(rays, hits); });
}

} // namespace relief
