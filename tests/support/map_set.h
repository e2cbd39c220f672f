// A hundred displacement maps by formulas, in the order t, b, n: sculpts that spread, twist, lean and fold in
// ways that a reader of their values could take for one another.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "math/vec.h"
#include "relief/scene.h"

namespace relief::test {

struct FormulaMap {
    std::string kind;                                ///< spiral, twist, vortex, mushroom, hook, ear, field
    std::function<Vec3f(float x, float y)> displace; ///< at a place of [-1, 1]^2
};

/// Falls to zero at the edges of the map.
inline float fade_at_edges(float x, float y) {
    const float m = std::clamp(std::min(1 - std::fabs(x), 1 - std::fabs(y)) / 0.3f, 0.0f, 1.0f);
    return m * m * (3 - 2 * m);
}

/// Numbers of a map, from the same seed on each machine: no distribution of the library is.
class Dice {
  public:
    explicit Dice(uint32_t seed) : random_(seed) {}
    float roll(float low, float high) { return low + (high - low) * float(random_() >> 8) / float(1 << 24); }
    float sign() { return random_() % 2 == 0 ? 1.0f : -1.0f; }

  private:
    std::mt19937 random_;
};

/// A bump that is turned by an angle that falls off with it, as a program twists points; arms run along it.
inline FormulaMap make_twist(Dice& dice, bool has_arms) {
    const float cx = dice.roll(-0.2f, 0.2f), cy = dice.roll(-0.2f, 0.2f), size = dice.roll(0.3f, 0.6f);
    const float angle = dice.sign() * dice.roll(0.6f, 4), height = dice.roll(0.2f, 0.8f);
    const float spread = has_arms ? dice.roll(-0.2f, 0.5f) : dice.roll(-0.1f, 0.1f);
    const float arms = has_arms ? std::floor(dice.roll(1, 5)) : 0;
    return {has_arms ? "spiral" : "twist", [=](float px, float py) {
                const float x = px - cx, y = py - cy, r = std::hypot(x, y);
                const float f = std::exp(-(r / size) * (r / size)), a = angle * f, k = 1 + spread * f;
                const float ridges =
                    arms > 0 ? 1 + 0.4f * std::cos(arms * std::atan2(y, x) + 6 * r / size) : 1;
                return Vec3f{k * (std::cos(a) * x - std::sin(a) * y) - x,
                             k * (std::sin(a) * x + std::cos(a) * y) - y, height * f * ridges};
            }};
}

/// A bump that slides straight along circles.
inline FormulaMap make_vortex(Dice& dice) {
    const float cx = dice.roll(-0.2f, 0.2f), cy = dice.roll(-0.2f, 0.2f), size = dice.roll(0.3f, 0.6f);
    const float slide = dice.sign() * dice.roll(0.3f, 3), height = dice.roll(0.2f, 0.8f),
                power = dice.roll(2, 8);
    return {"vortex", [=](float px, float py) {
                const float x = px - cx, y = py - cy, r = std::hypot(x, y) / size;
                const float f = std::exp(-std::pow(r, power));
                return Vec3f{-y * slide * f, x * slide * f, height * std::exp(-r * r)};
            }};
}

inline FormulaMap make_mushroom(Dice& dice) {
    const float cx = dice.roll(-0.2f, 0.2f), cy = dice.roll(-0.2f, 0.2f), size = dice.roll(0.35f, 0.6f);
    const float spread = dice.roll(0.8f, 1.8f), height = dice.roll(0.3f, 1);
    const float lean_x = dice.roll(-0.1f, 0.1f), lean_y = dice.roll(-0.1f, 0.1f);
    return {"mushroom", [=](float px, float py) {
                const float x = px - cx, y = py - cy, r = std::hypot(x, y) / size;
                const float f = std::exp(-std::pow(r, 4.0f)),
                            cap = std::exp(-std::pow((r - 0.5f) / 0.25f, 2.0f));
                return Vec3f{2 * spread * x * f * cap + lean_x * f * f,
                             2 * spread * y * f * cap + lean_y * f * f, height * f};
            }};
}

/// It leans to one side, further than it rises in some of them.
inline FormulaMap make_hook(Dice& dice) {
    const float cx = dice.roll(-0.3f, 0.3f), cy = dice.roll(-0.3f, 0.3f), size = dice.roll(0.2f, 0.45f);
    const float lean = dice.roll(0.1f, 1.2f), side = dice.roll(-0.4f, 0.4f), height = dice.roll(0.2f, 0.8f);
    const float turn = dice.roll(0, 2 * std::numbers::pi_v<float>);
    return {"hook", [=](float px, float py) {
                const float x = (px - cx) / size, y = (py - cy) / size, f = std::exp(-x * x - y * y);
                const float along = lean * f * f, across = side * f * f * f;
                return Vec3f{along * std::cos(turn) - across * std::sin(turn),
                             along * std::sin(turn) + across * std::cos(turn), height * f};
            }};
}

/// A rim that leans outwards around a bowl.
inline FormulaMap make_ear(Dice& dice) {
    const float cx = dice.roll(-0.1f, 0.1f), cy = dice.roll(-0.1f, 0.1f), lean = dice.roll(0.2f, 0.3f);
    const float turn = dice.roll(0, 2 * std::numbers::pi_v<float>);
    return {"ear", [=](float px, float py) {
                const float c = std::cos(turn), s = std::sin(turn);
                const float x = c * (px - cx) + s * (py - cy), y = -s * (px - cx) + c * (py - cy);
                const float d = std::hypot(x / 0.45f, y / 0.65f), r = std::max(std::hypot(x, y), 1e-6f);
                const float rim = std::exp(-std::pow((d - 0.75f) / 0.15f, 2.0f)),
                            base = std::exp(-std::pow(d, 4.0f));
                const float out = lean * rim * base / r;
                const float t = out * x + 0.01f * base, b = out * y;
                return Vec3f{c * t - s * b, s * t + c * b, 0.25f * base + 0.3f * rim * base};
            }};
}

/// Smooth waves in all three directions, with one that rises.
inline FormulaMap make_field(Dice& dice) {
    struct Wave {
        float x, y, phase, size;
    };
    std::vector<Wave> waves[3];
    const float along = dice.roll(0.02f, 0.15f);
    for (int c = 0; c < 3; ++c)
        for (int k = 0; k < 12; ++k)
            waves[c].push_back({dice.roll(-9, 9), dice.roll(-9, 9), dice.roll(0, 6.28f),
                                (c == 2 ? 0.04f : along) * dice.roll(0.3f, 1)});
    return {"field", [=](float x, float y) {
                float d[3] = {0, 0, 0.2f};
                for (int c = 0; c < 3; ++c)
                    for (const Wave& w : waves[c]) d[c] += w.size * std::sin(w.x * x + w.y * y + w.phase);
                return Vec3f{d[0], d[1], d[2]};
            }};
}

inline std::vector<FormulaMap> make_map_set() {
    std::vector<FormulaMap> maps;
    Dice dice(2015);
    for (int k = 0; k < 15; ++k) maps.push_back(make_twist(dice, true));
    for (int k = 0; k < 10; ++k) maps.push_back(make_twist(dice, false));
    for (int k = 0; k < 15; ++k) maps.push_back(make_vortex(dice));
    for (int k = 0; k < 15; ++k) maps.push_back(make_mushroom(dice));
    for (int k = 0; k < 15; ++k) maps.push_back(make_hook(dice));
    for (int k = 0; k < 15; ++k) maps.push_back(make_ear(dice));
    for (int k = 0; k < 15; ++k) maps.push_back(make_field(dice));
    return maps;
}

/// The same texels with channels along other axes; those of the texture are t, b, n.
inline std::shared_ptr<Texture> permute_channels(const Texture& texture, const AxisMap& axes) {
    auto permuted = std::make_shared<Texture>(texture);
    for (size_t k = 0; k < texture.floats.size(); k += 4)
        for (size_t c = 0; c < 3; ++c)
            permuted->floats[k + c] = texture.floats[k + axes.axis[c]] * float(axes.sign[c]);
    return permuted;
}

/// Its texels as 32-bit floats.
inline std::shared_ptr<Texture> make_formula_texture(const FormulaMap& map, uint32_t size) {
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = size, texture->channel_count = 3;
    for (uint32_t row = 0; row < size; ++row)
        for (uint32_t column = 0; column < size; ++column) {
            const float x = 2 * (float(column) + 0.5f) / float(size) - 1;
            const float y = 1 - 2 * (float(row) + 0.5f) / float(size);
            const Vec3f d = map.displace(x, y) * fade_at_edges(x, y);
            texture->floats.insert(texture->floats.end(), {d.x, d.y, d.z, 1.0f});
        }
    return texture;
}

} // namespace relief::test
