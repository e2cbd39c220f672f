#include "samples/scatter.h"

#include <algorithm>
#include <numbers>

#include "math/box.h"

namespace relief::samples {

namespace {

Box bound_body(const LatheBody& body) {
    Box box;
    for (int i = 0; i <= 64; ++i) {
        const float radius = body.point_at(0, float(i) / 64).radius();
        const float y = body.point_at(0, float(i) / 64).position.y;
        box.extend(Vec3f{-radius, y, -radius});
        box.extend(Vec3f{radius, y, radius});
    }
    return box;
}

} // namespace

size_t Scatter::cell_index(const Vec3f& p) const {
    const Vec3f q = (p - lower_) / cell_size_;
    const auto clamp = [](float x) { return size_t(std::clamp(int(x), 0, kCells - 1)); };
    return (clamp(q.z) * kCells + clamp(q.y)) * kCells + clamp(q.x);
}

Scatter::Scatter(const LatheBody& body, int tries, uint32_t seed, const RadiusRule& rule) {
    const Box box = bound_body(body);
    const Vec3f extent = box.extent();
    cell_size_ = 1.1f * std::max({extent.x, extent.y, extent.z}) / kCells;
    lower_ = box.center() - Vec3f{1, 1, 1} * (0.5f * cell_size_ * kCells);
    grid_.resize(size_t(kCells) * kCells * kCells);
    Random random(seed);
    float widest = 0;
    for (int i = 0; i <= 256; ++i) widest = std::max(widest, body.point_at(0, float(i) / 256).radius());
    for (int i = 0; i < tries; ++i) {
        const BodyPoint p = body.point_at(2 * std::numbers::pi_v<float> * random.unit(), random.unit());
        if (random.unit() * widest > p.radius()) continue;
        const std::optional<float> radius = rule(p, random);
        if (!radius) continue;
        const bool is_free = std::none_of(features_.begin(), features_.end(), [&](const Feature& other) {
            return length(other.centre - p.position) < other.radius + *radius;
        });
        if (!is_free) continue;
        const uint32_t index = uint32_t(features_.size());
        features_.push_back({p.position, p.normal, *radius, hash(int(index), 7, 3, seed)});
        const int reach = int(*radius / cell_size_) + 1;
        std::vector<size_t> cells;
        for (int z = -reach; z <= reach; ++z)
            for (int y = -reach; y <= reach; ++y)
                for (int x = -reach; x <= reach; ++x)
                    cells.push_back(
                        cell_index(p.position + Vec3f{float(x), float(y), float(z)} * cell_size_));
        std::sort(cells.begin(), cells.end());
        cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
        for (size_t cell : cells) grid_[cell].push_back(index);
    }
}

std::optional<FeatureHit> Scatter::find(const Vec3f& p) const {
    for (uint32_t index : grid_[cell_index(p)]) {
        const Feature& feature = features_[index];
        const Vec3f offset = p - feature.centre;
        const float distance = length(offset);
        if (distance >= feature.radius) continue;
        const Vec3f flat = offset - feature.normal * dot(offset, feature.normal);
        return FeatureHit{&feature, normalize(flat), distance / feature.radius};
    }
    return std::nullopt;
}

} // namespace relief::samples
