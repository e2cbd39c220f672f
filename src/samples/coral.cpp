// The coral: a ball covered with cups that lean every way, between them a skin of small grains.
#include <cmath>

#include "math/vec.h"
#include "samples/angles.h"
#include "samples/lathe_model.h"
#include "samples/models.h"
#include "samples/noise.h"
#include "samples/profile.h"
#include "samples/scatter.h"

namespace relief::samples {

namespace {

LatheShape make_coral_shape() {
    LatheShape shape;
    for (int i = 0; i <= 48; ++i) {
        const float a = kPi * float(i) / 48;
        shape.profile.push_back({i == 48 ? 0.0f : std::sin(a), -std::cos(a)});
    }
    shape.cap_cells = 8;
    shape.rows = 12;
    return shape;
}

class CoralSculptor {
  public:
    explicit CoralSculptor(const LatheBody& body)
        : polyps_(body, 12000, 131, [](const BodyPoint&, Random& random) -> std::optional<float> {
              const float u = random.unit();
              return lerp(0.05f, 0.21f, u * u);
          }) {}

    Sculpture sculpt(const BodyPoint& p) const {
        Sculpture result;
        const float swell = fractal_noise(p.position * 1.8f, 2, 141);
        const float grain = ridged_noise(p.position * 13.0f, 3, 142);
        result.offset = p.normal * (0.05f * swell);
        const auto hit = polyps_.find(p.position);
        const float bare = hit ? smooth_step(0.75f, 1.0f, hit->q) : 1.0f;
        result.offset += p.normal * (0.022f * grain * bare);
        result.color = lerp(Vec3f{0.20f, 0.035f, 0.07f}, Vec3f{0.62f, 0.17f, 0.16f}, grain);
        if (hit) add_polyp(p, *hit, result);
        return result;
    }

  private:
    void add_polyp(const BodyPoint& p, const FeatureHit& hit, Sculpture& result) const {
        const Feature& feature = *hit.feature;
        const Vec2f shape = cup_.at(hit.q);
        const float tall = (1.1f + 1.3f * to_unit(feature.seed)) * (0.10f / (0.05f + feature.radius) + 0.55f);
        const float height = shape.y * tall;
        // Flutes run up the outside of a cup and notch its rim.
        const Vec3f side = normalize(
            cross(feature.normal, std::fabs(feature.normal.y) < 0.9f ? Vec3f{0, 1, 0} : Vec3f{1, 0, 0}));
        const float angle = std::atan2(dot(hit.outward, cross(feature.normal, side)), dot(hit.outward, side));
        const float wall = smooth_step(0.18f, 0.36f, hit.q) * smooth_step(1.0f, 0.85f, hit.q);
        const float flutes = 0.5f + 0.5f * std::cos(angle * float(9 + feature.seed % 5));
        const float spread = shape.x * (1 + 0.13f * wall * (flutes - 0.5f)) - hit.q;
        const float lean_angle = 2 * kPi * to_unit(hash(int(feature.seed & 0xffff), 1, 2, 3));
        const Vec3f lean = side * std::cos(lean_angle) + cross(feature.normal, side) * std::sin(lean_angle);
        const float bend =
            0.30f * height * height * to_unit(hash(int(feature.seed & 0xffff), 5, 2, 3)) / tall;
        const float rough = 0.05f * wall * noise(p.position * 45.0f, 151);
        result.offset += hit.outward * (spread * feature.radius) + lean * (bend * feature.radius) +
                         feature.normal * (height * feature.radius * (1 + 0.06f * wall * flutes)) +
                         hit.outward * (rough * feature.radius);
        const float lift = smooth_step(0.1f, 1.0f, shape.y);
        const float hue = to_unit(hash(int(feature.seed & 0xffff), 9, 2, 3));
        const Vec3f body = lerp(Vec3f{0.80f, 0.22f, 0.16f}, Vec3f{0.85f, 0.42f, 0.14f}, hue);
        const Vec3f tip{0.95f, 0.80f, 0.62f}, inside{0.24f, 0.03f, 0.11f};
        Vec3f color = lerp(result.color, lerp(body, tip, lift * lift), smooth_step(0.0f, 0.3f, lift));
        color = lerp(inside, color, smooth_step(0.26f, 0.38f, hit.q));
        result.color = color * (1 - 0.25f * wall * (1 - flutes));
    }

    // Floor of the cup, its inner wall, the rim, the outer wall drawn in to a waist, the foot.
    FreeCurve cup_{{0, 0.50f},     {0.16f, 0.42f}, {0.28f, 0.50f}, {0.36f, 0.85f},
                   {0.50f, 1.05f}, {0.62f, 1.0f},  {0.60f, 0.75f}, {0.46f, 0.45f},
                   {0.42f, 0.25f}, {0.55f, 0.08f}, {1, 0}};
    Scatter polyps_;
};

} // namespace

Model make_coral(const ProgressFunction& on_progress) {
    return make_sculpted_model<CoralSculptor>("coral", make_coral_shape(), DisplacementSpace::object, 0.5f,
                                              on_progress);
}

} // namespace relief::samples
