#include "io/picture/display_transform.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <tuple>

#include "formulas/bsdf.h"
#include "formulas/tonemap.h"
#include "io/picture/agx.h"
#include "io/picture/picture_library.h"
#include "math/vec.h"

namespace relief {

namespace {

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

/// Exposed, without NaN, negative and infinite components.
Vec3f limit_color(const Vec3f& linear, const DisplaySettings& settings) {
    const auto limit = [&](float x) { return x > 0 ? std::min(x * settings.factor, 1e6f) : 0.0f; };
    return {limit(linear.x), limit(linear.y), limit(linear.z)};
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
    const Vec3f limited = limit_color(linear, settings);
    if (settings.transform == DisplayTransform::aces) return clamp_to_unit(settings.aces->apply(limited));
    if (settings.transform == DisplayTransform::raw) return clamp_to_unit(limited);
    const Vec3f shown = tone_map(limited, settings.transform);
    const auto encode = [](float x) { return std::min(scalar::encode_srgb(x), 1.0f); };
    return {encode(shown.x), encode(shown.y), encode(shown.z)};
}

Vec3f estimate_color(const Vec3f& linear, const DisplaySettings& settings) {
    if (settings.transform != DisplayTransform::agx) return show_color(linear, settings);
    return get_agx_table().show(limit_color(linear, settings));
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
