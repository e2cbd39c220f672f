#include "io/picture/display_transform.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <tuple>

#include "formulas/bsdf.h"
#include "formulas/tonemap.h"
#include "io/picture/picture_library.h"
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

float bend_log(float x) {
    constexpr float kLowest = -12.47393f, kHighest = 4.026069f; // log2 of 0.18, -10 and +6.5 EV
    const float log = std::log2(std::max(x, 1e-10f));
    return bend((std::clamp(log, kLowest, kHighest) - kLowest) / (kHighest - kLowest));
}

Vec3f tone_map_agx(const Vec3f& linear) {
    static const Matrix kOutset = invert(kInset);
    const Vec3f inset = multiply(kInset, linear);
    const Vec3f shown = multiply(kOutset, {bend_log(inset.x), bend_log(inset.y), bend_log(inset.z)});
    // The curve is meant for a display of exponent 2.2.
    const auto to_linear = [](float x) { return std::pow(std::clamp(x, 0.0f, 1.0f), 2.2f); };
    return {to_linear(shown.x), to_linear(shown.y), to_linear(shown.z)};
}

Vec3f tone_map(const Vec3f& linear, DisplayTransform transform) {
    switch (transform) {
    case DisplayTransform::agx:
        return tone_map_agx(linear);
    case DisplayTransform::filmic:
        return scalar::tone_map_filmic(linear);
    default:
        return {std::min(linear.x, 1.0f), std::min(linear.y, 1.0f), std::min(linear.z, 1.0f)};
    }
}

Vec3f clamp_to_unit(const Vec3f& c) {
    return {std::clamp(c.x, 0.0f, 1.0f), std::clamp(c.y, 0.0f, 1.0f), std::clamp(c.z, 0.0f, 1.0f)};
}

std::optional<std::string> find_entry(const Image& image, const char* key) {
    const auto found = image.metadata.find(key);
    return found == image.metadata.end() ? std::nullopt : std::optional(found->second);
}

float read_exposure(const Image& image) {
    const std::string text = find_entry(image, "relief:exposure").value_or("0");
    if (text == "auto") return find_exposure(image);
    float ev = 0;
    std::from_chars(text.data(), text.data() + text.size(), ev);
    return std::isfinite(ev) ? std::clamp(ev, -64.0f, 64.0f) : 0;
}

void read_background(const std::string& text, DisplaySettings& settings) {
    settings.is_transparent = text == "transparent";
    uint32_t rgb = 0;
    const char* const end = text.data() + text.size();
    if (text.size() != 7 || text[0] != '#' || std::from_chars(text.data() + 1, end, rgb, 16).ptr != end)
        return;
    settings.background =
        Vec3f{float(rgb >> 16 & 255), float(rgb >> 8 & 255), float(rgb & 255)} * (1.0f / 255);
}

/// Made once, which takes half a second, and never destroyed: its library may be gone by then.
std::shared_ptr<const ColorTransform> get_aces_display() {
    static const auto* const transform =
        new std::shared_ptr<const ColorTransform>(get_picture_library("ACES").make_aces_display());
    return *transform;
}

} // namespace

DisplaySettings read_display_settings(const Image& image) {
    DisplaySettings settings;
    if (const auto name = find_entry(image, "relief:display")) {
        const auto found = std::find(std::begin(kDisplayTransforms), std::end(kDisplayTransforms), *name);
        if (found != std::end(kDisplayTransforms))
            settings.transform = DisplayTransform(found - std::begin(kDisplayTransforms));
    }
    if (settings.transform == DisplayTransform::aces) settings.aces = get_aces_display();
    settings.factor = std::exp2(read_exposure(image));
    if (find_entry(image, "relief:png_bits") == "16") settings.bits = 16;
    if (const auto background = find_entry(image, "relief:background"))
        if (image.find_channel("A")) read_background(*background, settings);
    return settings;
}

Vec3f show_color(const Vec3f& linear, const DisplaySettings& settings) {
    const auto limit = [&](float x) { return x > 0 ? std::min(x * settings.factor, 1e6f) : 0.0f; };
    const Vec3f limited{limit(linear.x), limit(linear.y), limit(linear.z)};
    if (settings.transform == DisplayTransform::aces) return clamp_to_unit(settings.aces->apply(limited));
    if (settings.transform == DisplayTransform::raw) return clamp_to_unit(limited);
    const Vec3f shown = tone_map(limited, settings.transform);
    const auto encode = [](float x) { return std::min(scalar::encode_srgb(x), 1.0f); };
    return {encode(shown.x), encode(shown.y), encode(shown.z)};
}

float find_exposure(const Image& image) {
    const auto r = image.find_channel("R"), g = image.find_channel("G"), b = image.find_channel("B");
    if (!r || !g || !b) return 0;
    const auto a = image.find_channel("A");
    const auto sum_logs = [&](bool is_hit_only) {
        std::pair<double, size_t> sum{0, 0};
        for (size_t p = 0; p < image.pixels.size(); p += image.channels.size()) {
            const float* pixel = &image.pixels[p];
            const float y = scalar::luminance(Vec3f{pixel[*r], pixel[*g], pixel[*b]});
            if (!(y > 1e-6f) || !std::isfinite(y) || (is_hit_only && !(pixel[*a] > 0.5f))) continue;
            sum.first += std::log2(double(y)), ++sum.second;
        }
        return sum;
    };
    auto [sum, count] = sum_logs(a.has_value());
    if (count == 0) std::tie(sum, count) = sum_logs(false);
    if (count == 0) return 0;
    return std::clamp(float(std::log2(0.18) - sum / double(count)), -16.0f, 16.0f);
}

} // namespace relief
