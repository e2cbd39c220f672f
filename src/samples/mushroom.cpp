// The fly agaric: warts that sit on the cap, gills below it, a skirt about the stem, a scaly bulb.
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

constexpr int kGills = 56;
constexpr float kSkirtTop = 0.84f, kSkirtLength = 0.17f;

LatheShape make_mushroom_shape() {
    LatheShape shape;
    shape.profile = {{0, -0.03f},     {0.14f, -0.02f}, {0.25f, 0.04f},  {0.27f, 0.13f},  {0.215f, 0.25f},
                     {0.175f, 0.38f}, {0.16f, 0.55f},  {0.15f, 0.72f},  {0.145f, 0.87f}, {0.18f, 0.965f},
                     {0.34f, 0.985f}, {0.54f, 0.94f},  {0.70f, 0.875f}, {0.79f, 0.85f},  {0.825f, 0.885f},
                     {0.80f, 0.97f},  {0.69f, 1.12f},  {0.50f, 1.25f},  {0.26f, 1.33f},  {0, 1.36f}};
    shape.cap_cells = 6;
    shape.rows = 26;
    shape.cap_share = 0.1f;
    return shape;
}

bool is_cap_top(const BodyPoint& p) {
    return p.position.y > 0.86f && p.normal.y > 0.05f && p.radius() < 0.83f;
}

class MushroomSculptor {
  public:
    explicit MushroomSculptor(const LatheBody& body)
        : warts_(body, 16000, 71, [](const BodyPoint& p, Random& random) -> std::optional<float> {
              const float u = random.unit();
              if (!is_cap_top(p) || p.position.y < 0.93f) return std::nullopt;
              return lerp(0.022f, 0.088f, u * u) * smooth_step(0.8f, 1.35f, p.position.y + 0.1f);
          }) {}

    Sculpture sculpt(const BodyPoint& p) const {
        Sculpture result;
        if (p.position.y > 0.86f && p.normal.y > -0.35f) {
            add_cap(p, result);
            add_warts(p, result);
        } else if (p.radius() > 0.16f && p.position.y > 0.84f) {
            add_gills(p, result);
        } else {
            add_stem(p, result);
        }
        return result;
    }

  private:
    static void add_cap(const BodyPoint& p, Sculpture& result) {
        const float edge = smooth_step(-0.35f, 0.0f, p.normal.y);
        const float streak = noise({12 * std::cos(p.theta) * 2, 3 * p.radius(), 24 * std::sin(p.theta)}, 81);
        const float rim = smooth_step(1.05f, 0.9f, p.position.y);
        const float height = 0.018f * fractal_noise(p.position * 3.0f, 3, 82) + 0.006f * rim * streak +
                             0.0016f * fractal_noise(p.position * 60.0f, 2, 83);
        result.offset = p.normal * (height * edge);
        const float tone = 0.5f + 0.5f * fractal_noise(p.position * 4.0f, 4, 84);
        const Vec3f red = lerp(Vec3f{0.50f, 0.016f, 0.01f}, Vec3f{0.80f, 0.10f, 0.02f}, tone);
        result.color = lerp(Vec3f{0.84f, 0.74f, 0.52f}, red, edge);
        result.color = lerp(result.color, Vec3f{0.88f, 0.33f, 0.06f}, 0.55f * rim);
    }

    void add_warts(const BodyPoint& p, Sculpture& result) const {
        const auto hit = warts_.find(p.position);
        if (!hit) return;
        const float radius = hit->feature->radius;
        const float crumble = fractal_noise(p.position * (1.5f / radius), 3, hit->feature->seed);
        const Vec2f shape = wart_.at(hit->q);
        const float mask = smooth_step(1.0f, 0.8f, hit->q);
        const float spread =
            (shape.x - hit->q) * radius + 0.16f * radius * crumble * mask * smooth_step(0, 0.4f, hit->q);
        result.offset +=
            hit->outward * spread + p.normal * (shape.y * radius * (0.75f + 0.35f * crumble * mask));
        const Vec3f white =
            lerp(Vec3f{0.80f, 0.72f, 0.55f}, Vec3f{0.93f, 0.90f, 0.82f}, 0.5f + 0.5f * crumble);
        result.color = lerp(result.color, white, smooth_step(0.05f, 0.25f, shape.y));
    }

    void add_gills(const BodyPoint& p, Sculpture& result) const {
        const float r = p.radius();
        const float weight = smooth_step(0.165f, 0.30f, r) * smooth_step(0.80f, 0.70f, r);
        const float wave = 0.012f * noise(p.position * 9.0f, 91) + 0.004f * noise(p.position * 30.0f, 92);
        const float phase = (p.theta + wave / std::fmax(r, 0.2f)) * kGills / (2 * kPi);
        const float nearest = std::floor(phase + 0.5f), signed_q = 2 * (phase - nearest);
        const float q = std::fabs(signed_q), side = signed_q < 0 ? -1.0f : 1.0f;
        const Vec2f shape = gill_.at(q);
        const bool is_short = (int(nearest) % 2 + 2) % 2 == 1;
        const float depth = 0.085f * (is_short ? smooth_step(0.30f, 0.55f, r) : 1.0f) *
                            (1 + 0.15f * noise(p.position * 24.0f, 93));
        const float half_width = kPi / kGills * r;
        result.offset =
            p.around * (side * (shape.x - q) * half_width * weight) + p.normal * (shape.y * depth * weight);
        const Vec3f shadow{0.55f, 0.40f, 0.24f}, cream{0.90f, 0.82f, 0.64f};
        result.color = lerp(shadow, cream, lerp(1.0f, smooth_step(-0.1f, 0.7f, shape.y), weight));
    }

    void add_stem(const BodyPoint& p, Sculpture& result) const {
        const float y = p.position.y, c = std::cos(p.theta), w = std::sin(p.theta);
        const float fibre = fractal_noise({11 * c, 2.2f * y, 11 * w}, 4, 101);
        result.offset = p.normal * (0.012f * fibre * smooth_step(0.0f, 0.1f, p.radius()));
        result.color = lerp(Vec3f{0.70f, 0.60f, 0.42f}, Vec3f{0.92f, 0.88f, 0.76f}, 0.5f + 0.5f * fibre);
        const float q = (kSkirtTop - y) / kSkirtLength;
        if (q > 0 && q < 1 && p.radius() < 0.18f) {
            const Vec2f shape = skirt_.at(q);
            const float ruffle =
                0.16f * std::sin(9 * p.theta + 2) + 0.10f * std::sin(17 * p.theta) + 0.3f * fibre;
            const float out = shape.x * (1 + ruffle * smooth_step(0.02f, 0.12f, shape.x));
            const float target_y = kSkirtTop + shape.y + 0.10f * ruffle * shape.x;
            const Vec3f radial{c, 0, -w};
            result.offset += radial * out + Vec3f{0, target_y - y, 0};
            result.color = lerp(result.color, Vec3f{0.93f, 0.86f, 0.62f}, smooth_step(0.0f, 0.1f, shape.x));
        }
        add_bulb_scales(p, result);
    }

    /// Rings of torn scales about the bulb, each lip hanging over the next.
    void add_bulb_scales(const BodyPoint& p, Sculpture& result) const {
        const float y = p.position.y;
        const float weight = smooth_step(0.0f, 0.05f, y) * smooth_step(0.42f, 0.3f, y);
        if (weight <= 0) return;
        const float ragged =
            0.25f * fractal_noise({5 * std::cos(p.theta), 3 * y, 5 * std::sin(p.theta)}, 3, 111);
        const float row = y * 15 + ragged, q = row - std::floor(row), length_y = 1.0f / 15;
        const Vec2f shape = scale_.at(1 - q);
        const float strength =
            weight * (0.6f + 0.4f * noise({7 * std::cos(p.theta), 5 * y, 7 * std::sin(p.theta)}, 112));
        result.offset +=
            p.along * ((1 - q - shape.x) * length_y * strength) + p.normal * (0.045f * shape.y * strength);
        result.color =
            lerp(result.color, Vec3f{0.80f, 0.62f, 0.34f}, 0.6f * weight * smooth_step(0.6f, 1.0f, shape.y));
    }

    FreeCurve wart_{{0, 1.0f},      {0.3f, 1.0f},  {0.58f, 0.88f}, {0.78f, 0.62f},
                    {0.76f, 0.36f}, {0.62f, 0.2f}, {0.7f, 0.03f},  {1, 0}};
    MirroredCurve gill_{{0, -0.2f},    {0.25f, -0.1f}, {0.5f, 0.1f},  {0.58f, 0.4f},
                        {0.5f, 0.72f}, {0.46f, 0.9f},  {0.62f, 1.0f}, {1, 1.02f}};
    // Out from the stem and down to the hem, then back up below it; y counts from the top of the skirt.
    FreeCurve skirt_{{0, 0},          {0.05f, 0.005f},   {0.12f, -0.04f},   {0.17f, -0.12f},
                     {0.20f, -0.20f}, {0.205f, -0.235f}, {0.185f, -0.215f}, {0.13f, -0.12f},
                     {0.07f, -0.07f}, {0.02f, -0.09f},   {0, -0.17f}};
    // Down along a scale: its back, the lip beyond its own length, and under the lip back to the next one.
    FreeCurve scale_{{0, 0},         {0.4f, 0.5f}, {0.9f, 0.95f}, {1.3f, 1.05f},
                     {1.35f, 0.85f}, {1.1f, 0.5f}, {0.9f, 0.15f}, {1, 0}};
    Scatter warts_;
};

} // namespace

Model make_mushroom(const ProgressFunction& on_progress) {
    return make_sculpted_model<MushroomSculptor>("mushroom", make_mushroom_shape(),
                                                 DisplacementSpace::tangent, 0.35f, on_progress);
}

} // namespace relief::samples
