// A ring of scales: rows of overlapping plates, each with a keel, growth lines and a lip over the next row.
#include <cmath>

#include "math/vec.h"
#include "samples/bake.h"
#include "samples/lathe_model.h"
#include "samples/models.h"
#include "samples/noise.h"
#include "samples/profile.h"

namespace relief::samples {

namespace {

constexpr int kColumns = 12, kRows = 24; ///< of a tile; rows lie half a column's width apart
constexpr float kDiscRadius = 0.72f;     ///< of a scale, in widths of a column: discs cover the plane
constexpr float kTileLength = 2.15f;     ///< of the torus under the map, object units

/// Where a place lies on the scale that shows there.
struct ScaleHit {
    float across = 0, along = 0; ///< from the scale's centre, widths of a column
    float root = 0;              ///< distance from the edges of the rows above, >= 0
    uint32_t seed = 0;
};

/// Centre to point, for the disc of row `row` nearest across; and its column.
Vec2f offset_to_scale(int row, const Vec2f& p, int& column) {
    const float shift = row % 2 == 0 ? 0.0f : 0.5f;
    column = int(std::floor(p.y - shift + 0.5f));
    return {p.x - 0.5f * float(row), p.y - (float(column) + shift)};
}

ScaleHit find_scale(const Vec2f& p) {
    ScaleHit hit;
    hit.root = 1e30f;
    // The first row whose disc holds the point lies on top: tips point towards greater x.
    for (int row = int(std::floor((p.x - kDiscRadius) / 0.5f)) - 1;; ++row) {
        int column = 0;
        const Vec2f d = offset_to_scale(row, p, column);
        const float distance = length(d);
        if (distance < kDiscRadius) {
            hit.along = d.x, hit.across = d.y;
            hit.seed = hash(wrap(row, kRows), wrap(column, kColumns), 0, 211);
            return hit;
        }
        if (d.x > 0) hit.root = std::fmin(hit.root, distance - kDiscRadius);
    }
}

class ScaleSculptor {
  public:
    MapSample sculpt(const Vec2f& uv) const {
        const ScaleHit hit = find_scale({uv.x * kColumns, uv.y * kColumns});
        const float distance = std::sqrt(hit.across * hit.across + hit.along * hit.along);
        const float q = std::fmin(distance / kDiscRadius, 1.0f), own = to_unit(hit.seed);
        const Vec2f shape = lip_.at(q), outward = distance > 1e-6f
                                                      ? Vec2f{hit.along / distance, hit.across / distance}
                                                      : Vec2f{1, 0};
        const float rooted = smooth_step(0.0f, 0.14f, hit.root);
        const float keel = std::exp(-hit.across * hit.across / 0.006f) * smooth_step(0.0f, 0.25f, shape.y);
        const float rings = std::sin(52 * q + 9 * own + 1.5f * tile_noise(uv * 96.0f, 96, 96, 212));
        const float rough = fractal_tile_noise(uv * 80.0f, 80, 80, 4, 213);
        const float top = smooth_step(0.5f, 0.9f, shape.y);
        const float push = (shape.x - q) * kDiscRadius * rooted * (0.85f + 0.3f * own);
        const float height =
            (0.42f * shape.y * (0.75f + 0.5f * own) + 0.085f * keel + 0.008f * rings * top + 0.02f * rough) *
            rooted * kDiscRadius;
        // The middle of the tip reaches furthest, which points the scale.
        const float point = 0.20f * keel * smooth_step(0.55f, 0.8f, q) * smooth_step(1.0f, 0.88f, q) * rooted;
        MapSample sample;
        sample.displacement = Vec3f{outward.x * push + point, outward.y * push, height} * (1.0f / kColumns);
        sample.color = paint(q, shape.y, own, keel, rings, rough, rooted);
        return sample;
    }

  private:
    static Vec3f paint(float q, float height, float own, float keel, float rings, float rough, float rooted) {
        const Vec3f deep{0.008f, 0.045f, 0.05f}, teal{0.02f, 0.26f, 0.24f}, jade{0.12f, 0.42f, 0.12f};
        const Vec3f gold{0.80f, 0.48f, 0.12f};
        Vec3f color =
            lerp(deep, lerp(teal, jade, own), smooth_step(0.1f, 0.8f, height) * (0.75f + 0.25f * rough));
        color *= 1 + 0.15f * rings;
        const float edge = smooth_step(0.42f, 0.62f, q) * smooth_step(0.3f, 0.9f, height);
        color = lerp(color, gold, 0.75f * edge);
        color = lerp(color, gold * 0.8f, 0.5f * keel);
        return color * (0.35f + 0.65f * rooted);
    }

    FreeCurve lip_{{0, 0.25f},     {0.22f, 0.40f}, {0.48f, 0.60f}, {0.80f, 0.84f}, {1.10f, 1.0f},
                   {1.26f, 0.98f}, {1.20f, 0.74f}, {1.02f, 0.35f}, {0.94f, 0.08f}, {1, 0}};
};

} // namespace

Model make_scale_ring(const ProgressFunction& on_progress) {
    const ScaleSculptor sculptor;
    Model model = bake_model(
        "scales", DisplacementSpace::tangent, WrapMode::repeat, Texels::halves,
        [&](Vec2f uv) { return sculptor.sculpt(uv); }, on_progress);
    model.displacement.scale = Vec3f{1, 1, 1} * kTileLength;
    model.material.roughness = 0.32f;
    TorusShape shape;
    shape.minor_radius = 0.36f;
    shape.uv_repeats = 3;
    model.make_mesh = [shape](const Deformation& deform) { return make_torus(shape, deform); };
    return model;
}

} // namespace relief::samples
