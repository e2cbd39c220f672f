#include "surface/map/dequantize.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace relief {

namespace {

// A plateau that is w texels wide needs a filter as wide, and a filter that is too wide pulls detail out of
// the half step, where clipping would bring the stairs back. So filters of growing width and then of falling
// width take part only where they stay within the half step all around.
constexpr std::array<int64_t, 7> kSpacings = {1, 2, 4, 8, 4, 2, 1};
constexpr float kMostExcess =
    1.0f / 32; ///< mean excess over half a step, in steps, at which a filter is left out

/// A rectangle that shrinks as filters run over it.
struct Window {
    int64_t x0, y0, x1, y1;

    Window without(int64_t margin) const { return {x0 + margin, y0 + margin, x1 - margin, y1 - margin}; }
};

/// Binomial filter 1 4 6 4 1 of texels `spacing` apart, along x and then along y, over `window`. `between`:
/// room of the same size.
void smooth(const TexelPlane& from, int64_t spacing, const Window& window, TexelPlane& between,
            TexelPlane& to) {
    constexpr float kOuter = 1.0f / 16, kInner = 4.0f / 16, kMiddle = 6.0f / 16;
    const auto blend = [](float a, float b, float c, float d, float e) {
        return (a + e) * kOuter + (b + d) * kInner + c * kMiddle;
    };
    const int64_t count = window.x1 - window.x0, s = spacing;
    for (int64_t y = window.y0 - 2 * s; y < window.y1 + 2 * s; ++y) {
        const float* source = from.at(window.x0, y);
        float* target = between.at(window.x0, y);
        for (int64_t k = 0; k < count; ++k)
            target[k] = blend(source[k - 2 * s], source[k - s], source[k], source[k + s], source[k + 2 * s]);
    }
    for (int64_t y = window.y0; y < window.y1; ++y) {
        const float *a = between.at(window.x0, y - 2 * s), *b = between.at(window.x0, y - s),
                    *c = between.at(window.x0, y), *d = between.at(window.x0, y + s),
                    *e = between.at(window.x0, y + 2 * s);
        float* target = to.at(window.x0, y);
        for (int64_t k = 0; k < count; ++k) target[k] = blend(a[k], b[k], c[k], d[k], e[k]);
    }
}

template <class Visit> void visit_rows(const Window& window, const Visit& visit) {
    for (int64_t y = window.y0; y < window.y1; ++y)
        for (int64_t x = window.x0; x < window.x1; ++x) visit(x, y);
}

} // namespace

float get_quantization_step(SampleType type) {
    if (type == SampleType::uint8) return 1.0f / 255;
    if (type == SampleType::uint16) return 1.0f / 65535;
    return 0;
}

int64_t get_dequantization_reach() {
    int64_t reach = 0;
    for (const int64_t spacing : kSpacings) reach += 4 * spacing;
    return reach;
}

void dequantize(TexelPlane& plane, float step) {
    const TexelPlane stored = plane;
    TexelPlane smoothed = plane, excess = plane, between = plane, mean_excess = plane;
    const float inverse = 1 / step;
    Window window{plane.x0, plane.y0, plane.x0 + plane.width, plane.y0 + plane.height};
    for (const int64_t spacing : kSpacings) {
        window = window.without(2 * spacing);
        smooth(plane, spacing, window, between, smoothed);
        visit_rows(window, [&](int64_t x, int64_t y) {
            const float distance = std::fabs(*smoothed.at(x, y) - *stored.at(x, y)) * inverse;
            *excess.at(x, y) = std::max(0.0f, distance - 0.5f);
        });
        window = window.without(2 * spacing);
        smooth(excess, spacing, window, between, mean_excess);
        visit_rows(window, [&](int64_t x, int64_t y) {
            const float share = std::max(0.0f, 1 - *mean_excess.at(x, y) * (1 / kMostExcess));
            float& value = *plane.at(x, y);
            value += share * (*smoothed.at(x, y) - value);
        });
    }
    visit_rows(window, [&](int64_t x, int64_t y) {
        const float low = *stored.at(x, y) - 0.5f * step, high = *stored.at(x, y) + 0.5f * step;
        *plane.at(x, y) = std::clamp(*plane.at(x, y), low, high);
    });
}

} // namespace relief
