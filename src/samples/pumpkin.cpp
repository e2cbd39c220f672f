// The pumpkin: ribs that bulge over their creases, warts, cork veins and a bent stem.
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

constexpr int kRibs = 11;
constexpr float kStemRadius = 0.19f;

LatheShape make_pumpkin_shape() {
    LatheShape shape;
    for (int i = 0; i <= 48; ++i) {
        const float a = kPi * float(i) / 48, r = i == 48 ? 0.0f : std::sin(a);
        const float dimple = std::exp(-r * r / 0.09f);
        shape.profile.push_back({r, -std::cos(a) * (0.8f - 0.22f * dimple)});
    }
    return shape;
}

class PumpkinSculptor {
  public:
    explicit PumpkinSculptor(const LatheBody& body)
        : warts_(body, 9000, 11, [](const BodyPoint& p, Random& random) -> std::optional<float> {
              const float cluster = fractal_noise(p.position * 1.7f, 2, 5) + 0.35f * p.position.x;
              const float u = random.unit();
              if (p.radius() < 0.33f || cluster < 0.02f) return std::nullopt;
              return lerp(0.016f, 0.062f, u * u * u) * smooth_step(0.0f, 0.3f, cluster) + 0.008f;
          }) {}

    Sculpture sculpt(const BodyPoint& p) const {
        Sculpture result;
        const float ribs = add_ribs(p, result);
        add_skin(p, ribs, result);
        add_warts(p, result);
        add_stem(p, result);
        return result;
    }

  private:
    /// Returns how far from a crease the place is: 0 in it, 1 on the back of a rib.
    float add_ribs(const BodyPoint& p, Sculpture& result) const {
        const float wobble = 0.05f * noise(p.position * 2.3f, 21) + 0.02f * noise(p.position * 7.0f, 22);
        const float phase = (p.theta + wobble * smooth_step(0.1f, 0.5f, p.radius())) * kRibs / (2 * kPi);
        const float nearest = std::floor(phase + 0.5f), signed_q = 2 * (phase - nearest);
        const float q = std::fabs(signed_q), side = signed_q < 0 ? -1.0f : 1.0f;
        const float r = p.radius(), half_width = kPi / kRibs * r;
        const float strength = smooth_step(0.05f, 0.7f, r);
        const Vec2f shape = rib_.at(q);
        const int rib = int(std::floor(phase)) % kRibs;
        const float height = 0.13f + 0.05f * to_unit(hash(rib < 0 ? rib + kRibs : rib, 0, 0, 33)) * q;
        result.offset = p.around * (side * (shape.x - q) * half_width * strength) +
                        p.normal * ((shape.y - 0.85f) * height * strength);
        const float shade = smooth_step(0.02f, 0.75f, shape.y);
        const Vec3f deep{0.36f, 0.075f, 0.012f}, ripe{0.86f, 0.30f, 0.035f}, pale{0.93f, 0.52f, 0.14f};
        const float blotch = 0.5f + 0.5f * fractal_noise(p.position * 3.1f, 4, 41);
        result.color = lerp(deep, lerp(ripe, pale, smooth_step(0.55f, 0.95f, blotch)), shade);
        const float green = smooth_step(0.25f, 0.85f, p.position.y + 0.25f * blotch - 0.35f * shade + 0.1f);
        result.color = lerp(result.color, Vec3f{0.16f, 0.20f, 0.035f}, 0.75f * green);
        return q;
    }

    void add_skin(const BodyPoint& p, float rib, Sculpture& result) const {
        const Vec3f stretched{p.position.x, 0.45f * p.position.y, p.position.z};
        float height = 0.03f * fractal_noise(p.position * 2.6f, 3, 51) +
                       0.004f * fractal_noise(stretched * 22.0f, 4, 52);
        const float pore = noise(p.position * 75.0f, 53);
        height -= 0.0045f * smooth_step(0.35f, 0.6f, pore);
        const float zone =
            smooth_step(-0.05f, 0.3f, fractal_noise(p.position * 1.3f, 2, 57) - 0.25f * p.position.x);
        const Vec3f warped = p.position * 5.5f + Vec3f{1, 1, 1} * (0.8f * noise(p.position * 6.0f, 54));
        const float vein = zone * smooth_step(0.07f, 0.0f, std::fabs(noise(warped, 55))) *
                           smooth_step(-0.2f, 0.3f, noise(p.position * 9.0f, 56));
        height += vein * (0.012f + 0.006f * noise(p.position * 60.0f, 58));
        result.offset +=
            p.normal * (height * smooth_step(0.1f, 0.4f, p.radius()) * smooth_step(0.1f, 0.5f, rib));
        result.color = lerp(result.color, Vec3f{0.70f, 0.50f, 0.28f}, 0.85f * vein);
        result.color *= 1 - 0.25f * smooth_step(0.35f, 0.6f, pore);
    }

    void add_warts(const BodyPoint& p, Sculpture& result) const {
        const auto hit = warts_.find(p.position);
        if (!hit) return;
        const float lumps = 1 + 0.18f * noise(p.position * (1.1f / hit->feature->radius), hit->feature->seed);
        const Vec2f shape = wart_.at(hit->q);
        const float radius = hit->feature->radius;
        result.offset += hit->outward * ((shape.x - hit->q) * radius) + p.normal * (shape.y * radius * lumps);
        const float top = smooth_step(0.3f, 1.1f, shape.y);
        const float hue = to_unit(hit->feature->seed);
        const Vec3f tip = lerp(Vec3f{0.80f, 0.55f, 0.26f}, Vec3f{0.42f, 0.40f, 0.13f}, hue * hue);
        result.color = lerp(result.color, tip, 0.8f * top);
    }

    /// The stem replaces what is there: its surface is a curve of rings about a bent axis.
    void add_stem(const BodyPoint& p, Sculpture& result) const {
        const float r = p.radius();
        if (p.position.y < 0 || r >= kStemRadius) return;
        const float q = r / kStemRadius, fade = smooth_step(1.0f, 0.86f, q);
        const Vec2f shape = stem_.at(q);
        const float twisted = p.theta + 1.6f * shape.y;
        const float flutes = 0.16f * std::cos(5 * twisted) + 0.05f * std::cos(11 * twisted + 1);
        const float grain =
            0.03f * noise({3 * std::cos(twisted) * 3, shape.y * 9, 9 * std::sin(twisted)}, 61);
        const float radius = shape.x * (1 + (flutes + grain) * smooth_step(0.0f, 0.35f, q));
        const float bend = 0.75f * shape.y * shape.y;
        const Vec3f axis{bend, shape.y - 0.10f * bend, 0.35f * bend};
        const float base = 0.57f;
        const Vec3f target = Vec3f{std::cos(p.theta) * radius, base, -std::sin(p.theta) * radius} + axis;
        result.offset = lerp(result.offset, target - p.position, fade);
        const float groove = smooth_step(-0.2f, 0.1f, flutes);
        const Vec3f bark = lerp(Vec3f{0.10f, 0.085f, 0.03f}, Vec3f{0.34f, 0.33f, 0.13f}, groove);
        const Vec3f cut{0.52f, 0.42f, 0.24f};
        result.color = lerp(result.color, lerp(cut, bark, smooth_step(0.22f, 0.34f, q)), fade);
    }

    MirroredCurve rib_{{0, 0},         {0.11f, 0.0f},  {0.20f, 0.18f}, {0.17f, 0.42f}, {0.10f, 0.62f},
                       {0.15f, 0.80f}, {0.36f, 0.95f}, {0.66f, 1.03f}, {1, 1.06f}};
    FreeCurve wart_{{0, 1.15f},     {0.28f, 1.10f}, {0.55f, 0.94f}, {0.72f, 0.66f},
                    {0.69f, 0.38f}, {0.58f, 0.18f}, {0.68f, 0.04f}, {1, 0}};
    FreeCurve stem_{{0, 0.49f},      {0.07f, 0.495f}, {0.105f, 0.47f}, {0.095f, 0.40f},
                    {0.075f, 0.27f}, {0.08f, 0.14f},  {0.12f, 0.04f},  {0.19f, -0.01f}};
    Scatter warts_;
};

} // namespace

Model make_pumpkin(const ProgressFunction& on_progress) {
    return make_sculpted_model<PumpkinSculptor>("pumpkin", make_pumpkin_shape(), DisplacementSpace::object,
                                                0.42f, on_progress);
}

} // namespace relief::samples
