// The ear, all displacement of one quad: rolled rim, inner ridge, undercut bowl, flap at the canal.
#include <cmath>

#include "samples/bake.h"
#include "samples/lathe_model.h"
#include "samples/models.h"
#include "samples/noise.h"
#include "samples/outline.h"
#include "samples/profile.h"

namespace relief::samples {

namespace {

constexpr float kEarSize = 1.22f;                  ///< of the drawing below on the quad
constexpr float kRimFrom = -0.13f, kRimTo = 0.21f; ///< band about the outline that the rim's profile covers

float bump(const Vec2f& p, const Vec2f& centre, float radius) {
    const Vec2f d = p - centre;
    return std::exp(-(d.x * d.x + d.y * d.y) / (radius * radius));
}

class EarSculptor {
  public:
    MapSample sculpt(const Vec2f& uv) const {
        const Vec2f p{(2 * uv.x - 1) / kEarSize, (2 * uv.y - 1) / kEarSize};
        Vec3f move;
        const float stand_off = 0.10f + 0.30f * smooth_step(-0.34f, 0.45f, p.x + 0.12f * p.y);
        const OutlineHit edge = outline_.find(p);
        const float q = (edge.distance - kRimFrom) / (kRimTo - kRimFrom);
        const float roll = smooth_step(-0.42f, -0.12f, p.y) * smooth_step(-0.52f, -0.20f, p.x + 0.5f * p.y);
        const float front = smooth_step(-0.10f, -0.30f, p.x) * smooth_step(0.34f, 0.10f, p.y);
        const Vec2f rolled = rolled_.at(q), plain = plain_.at(q), flat = flat_.at(q);
        const Vec2f shape = lerp2(lerp2(plain, rolled, roll), flat, front);
        const float fade = smooth_step(-0.5f, 0.3f, q);
        const float shift = q > 0 && q < 1 ? shape.x - lerp(kRimFrom, kRimTo, q) : 0.0f;
        move.x = edge.inward.x * shift, move.y = edge.inward.y * shift, move.z = shape.y * stand_off * fade;
        const float inside = smooth_step(0.05f, 0.16f, edge.distance);
        add_inner_forms(p, inside, move);
        MapSample sample;
        add_skin(p, inside, move, sample);
        sample.displacement = {move.x * kEarSize, move.y * kEarSize, move.z * kEarSize};
        return sample;
    }

  private:
    static Vec2f lerp2(const Vec2f& a, const Vec2f& b, float f) { return a + (b - a) * f; }

    void add_inner_forms(const Vec2f& p, float inside, Vec3f& move) const {
        const float ridge = ridge_.find(p).distance, fork = fork_.find(p).distance;
        const float crest = std::exp(-ridge * ridge / 0.0040f), branch = std::exp(-fork * fork / 0.0034f);
        move.z += inside * (0.115f * crest + 0.075f * branch * (1 - crest));
        // The ridge leans over the bowl.
        move.x -= inside * 0.055f * crest * smooth_step(0.4f, -0.1f, p.y);
        const OutlineHit wall = bowl_.find(p);
        const float q = (wall.distance + 0.05f) / 0.17f;
        const Vec2f shape = wall_.at(q);
        const float shift = q > 0 && q < 1 ? shape.x - (q * 0.17f - 0.05f) : 0.0f;
        move.x += wall.inward.x * shift, move.y += wall.inward.y * shift;
        move.z -= 0.21f * shape.y;
        const float canal = bump(p, {-0.135f, -0.10f}, 0.055f);
        move.z -= 0.22f * canal;
        move.x -= 0.05f * canal;
        const float crus = bump({p.x * 0.6f + 0.05f, p.y}, {-0.015f, 0.075f}, 0.05f);
        move.z += 0.085f * crus;
        const float flap = bump({p.x, 0.75f * p.y}, {-0.245f, -0.075f}, 0.062f);
        move.z += 0.15f * flap;
        move.x += 0.10f * flap;
        const float opposite = bump(p, {-0.045f, -0.285f}, 0.062f);
        move.z += 0.11f * opposite;
        move.y += 0.06f * opposite;
        move.z += 0.05f * bump(p, {-0.11f, -0.47f}, 0.13f);
    }

    static void add_skin(const Vec2f& p, float inside, Vec3f& move, MapSample& sample) {
        const Vec3f at{p.x, p.y, move.z};
        const float soft = fractal_noise(at * 6.0f, 3, 221), pores = noise(at * 95.0f, 222),
                    lines = ridged_noise(at * 34.0f, 3, 223);
        move.z += 0.006f * soft - 0.0011f * smooth_step(0.1f, 0.5f, pores) - 0.0013f * lines;
        const Vec3f skin{0.72f, 0.43f, 0.31f}, pale{0.83f, 0.58f, 0.45f}, blood{0.62f, 0.20f, 0.14f};
        const float warmth = smooth_step(0.05f, -0.2f, move.z - 0.25f) * inside;
        sample.color = lerp(lerp(skin, pale, 0.5f + 0.5f * soft), blood, 0.55f * warmth);
        sample.color *= 1 - 0.12f * smooth_step(0.1f, 0.5f, pores) - 0.10f * lines;
    }

    ClosedOutline outline_{{-0.30f, 0.10f},  {-0.29f, -0.10f}, {-0.29f, -0.30f}, {-0.27f, -0.48f},
                           {-0.16f, -0.63f}, {0.02f, -0.63f},  {0.16f, -0.50f},  {0.30f, -0.29f},
                           {0.40f, -0.04f},  {0.47f, 0.24f},   {0.40f, 0.50f},   {0.20f, 0.66f},
                           {-0.06f, 0.66f},  {-0.25f, 0.50f},  {-0.32f, 0.30f}};
    OpenOutline ridge_{{0.10f, 0.46f},   {0.16f, 0.30f},  {0.21f, 0.12f},
                       {0.205f, -0.06f}, {0.12f, -0.20f}, {0.02f, -0.29f}};
    OpenOutline fork_{{-0.16f, 0.30f}, {-0.04f, 0.31f}, {0.08f, 0.25f}, {0.17f, 0.15f}};
    ClosedOutline bowl_{{-0.22f, -0.05f}, {-0.17f, -0.20f}, {-0.05f, -0.25f},
                        {0.07f, -0.17f},  {0.135f, -0.03f}, {0.12f, 0.11f},
                        {0.02f, 0.19f},   {-0.12f, 0.18f},  {-0.21f, 0.09f}};
    // From the head, under the rim, up to its edge, over it and down its inner roll to the hollow.
    FreeCurve rolled_{{-0.13f, 0},      {-0.03f, 0.0f},  {0.045f, 0.10f}, {0.045f, 0.42f}, {-0.005f, 0.70f},
                      {-0.045f, 0.92f}, {-0.03f, 1.12f}, {0.03f, 1.17f},  {0.085f, 1.06f}, {0.085f, 0.90f},
                      {0.065f, 0.76f},  {0.10f, 0.68f},  {0.15f, 0.70f},  {0.21f, 0.75f}};
    FreeCurve plain_{{-0.13f, 0},     {-0.04f, 0.0f},  {0.03f, 0.10f},  {0.035f, 0.38f}, {0.0f, 0.60f},
                     {-0.03f, 0.78f}, {-0.02f, 0.95f}, {0.02f, 1.02f},  {0.055f, 1.0f},  {0.085f, 0.96f},
                     {0.11f, 0.91f},  {0.14f, 0.86f},  {0.175f, 0.80f}, {0.21f, 0.75f}};
    FreeCurve flat_{{-0.13f, 0},    {-0.06f, 0.15f}, {0.0f, 0.40f},
                    {0.06f, 0.60f}, {0.12f, 0.70f},  {0.21f, 0.75f}};
    // From outside of the bowl: its edge, the wall cut back under it, the floor.
    FreeCurve wall_{{-0.05f, 0},      {-0.015f, -0.04f}, {0.02f, 0.0f},  {0.022f, 0.25f},
                    {-0.005f, 0.55f}, {0.005f, 0.85f},   {0.05f, 0.98f}, {0.12f, 1.0f}};
};

} // namespace

Model make_ear(const ProgressFunction& on_progress) {
    const EarSculptor sculptor;
    // One quad carries the whole map, so steps of half floats at the height of the rim would show as grain.
    Model model = bake_model(
        "ear", DisplacementSpace::tangent, WrapMode::clamp, Texels::floats,
        [&](Vec2f uv) { return sculptor.sculpt(uv); }, on_progress);
    model.material.roughness = 0.45f;
    model.make_mesh = [](const Deformation& deform) {
        Mesh mesh = make_single_quad();
        for (Vec3f& p : mesh.positions) p = deform(p);
        return mesh;
    };
    return model;
}

} // namespace relief::samples
