#include "io/picture/agx.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "formulas/tonemap.h"
#include "math/vec.h"

namespace relief {

namespace {

using Matrix = std::array<Vec3f, 3>; ///< rows

Vec3f multiply(const Matrix& m, const Vec3f& v) { return {dot(m[0], v), dot(m[1], v), dot(m[2], v)}; }

Matrix invert(const Matrix& m) {
    const Vec3f a = cross(m[1], m[2]), b = cross(m[2], m[0]), c = cross(m[0], m[1]);
    const float scale = 1 / dot(m[0], a);
    return {Vec3f{a.x, b.x, c.x} * scale, Vec3f{a.y, b.y, c.y} * scale, Vec3f{a.z, b.z, c.z} * scale};
}

/// Rec.709 to the inset primaries (figures: Wrensch 2023, "Minimal AgX Implementation").
constexpr Matrix kInset = {Vec3f{0.842479062253094f, 0.0784335999999992f, 0.0792237451477643f},
                           Vec3f{0.0423282422610123f, 0.878468636469772f, 0.0791661274605434f},
                           Vec3f{0.0423756549057051f, 0.0784336f, 0.879142973793104f}};

/// One side of Sobotka's curve: from the pivot with slope 2, a hyperbola that reaches 0 or 1 at the end.
struct CurveSide {
    float power, scale;
};

constexpr float kPivotX = 10.0f / 16.5f, kPivotY = 0.5f, kSlope = 2;

CurveSide make_side(float x, float y, float power) {
    return {power,
            std::pow(std::pow(kSlope * x, -power) * (std::pow(kSlope * (x / y), power) - 1), -1 / power)};
}

float bend(float x) {
    static const CurveSide kToe = make_side(kPivotX, kPivotY, 3.0f);
    static const CurveSide kShoulder = make_side(1 - kPivotX, 1 - kPivotY, 3.25f);
    const CurveSide& side = x < kPivotX ? kToe : kShoulder;
    const float term = kSlope * std::fabs(x - kPivotX) / side.scale;
    const float rise = side.scale * term / std::pow(1 + std::pow(term, side.power), 1 / side.power);
    return x < kPivotX ? kPivotY - rise : kPivotY + rise;
}

constexpr float kLowest = -12.47393f, kHighest = 4.026069f; // log2 of 0.18, -10 and +6.5 EV

float bend_log(float x) {
    const float log = std::log2(std::max(x, 1e-10f));
    return bend((std::clamp(log, kLowest, kHighest) - kLowest) / (kHighest - kLowest));
}

const Matrix& get_outset() {
    static const Matrix kOutset = invert(kInset);
    return kOutset;
}

/// The curve is meant for a display of exponent 2.2.
float to_linear(float x) { return std::pow(std::clamp(x, 0.0f, 1.0f), 2.2f); }

} // namespace

Vec3f tone_map_agx(const Vec3f& linear) {
    const Vec3f inset = multiply(kInset, linear);
    const Vec3f shown = multiply(get_outset(), {bend_log(inset.x), bend_log(inset.y), bend_log(inset.z)});
    return {to_linear(shown.x), to_linear(shown.y), to_linear(shown.z)};
}

AgxTable::AgxTable() : least_(std::exp2(kLowest)), most_(std::exp2(kHighest)) {
    // The curve goes on beyond its ends, so that no kink is between two entries.
    for (uint32_t k = 0; k < kBentCount; ++k) {
        const float log = std::log2(std::bit_cast<float>((kFirstStep + k) << kStepBits));
        bent_[k] = bend((log - kLowest) / (kHighest - kLowest));
    }
    for (uint32_t k = 0; k <= kCodeCount; ++k)
        codes_[k] = scalar::encode_srgb(to_linear(float(k) / kCodeCount));
    codes_[kCodeCount + 1] = codes_[kCodeCount];
}

float AgxTable::find_bent(float x) const {
    const float limited = std::clamp(x, least_, most_);
    const auto bits = std::bit_cast<uint32_t>(limited);
    const uint32_t entry = (bits >> kStepBits) - kFirstStep;
    const float share = float(bits & ((1u << kStepBits) - 1)) * (1.0f / (1u << kStepBits));
    return bent_[entry] + (bent_[entry + 1] - bent_[entry]) * share;
}

float AgxTable::find_code(float x) const {
    const float place = std::clamp(x, 0.0f, 1.0f) * kCodeCount;
    const auto entry = uint32_t(place);
    return codes_[entry] + (codes_[entry + 1] - codes_[entry]) * (place - float(entry));
}

Vec3f AgxTable::show(const Vec3f& linear) const {
    const Vec3f inset = multiply(kInset, linear);
    const Vec3f shown = multiply(get_outset(), {find_bent(inset.x), find_bent(inset.y), find_bent(inset.z)});
    return {find_code(shown.x), find_code(shown.y), find_code(shown.z)};
}

const AgxTable& get_agx_table() {
    static const AgxTable table;
    return table;
}

} // namespace relief
