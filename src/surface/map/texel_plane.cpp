#include "surface/map/texel_plane.h"

#include "image/texel_layout.h"
#include "surface/map/texels.h"

namespace relief {

namespace {

/// What an index of one axis stands for.
struct Continuation {
    int64_t index = 0;
    bool is_outside = false, is_turned = false;
};

/// Odd about the texels at -1 and at `size`, which have the outside's value: of period 2 (size + 1).
Continuation turn_about_outside(int64_t index, int64_t size) {
    const int64_t period = 2 * (size + 1), rest = ((index + 1) % period + period) % period;
    if (rest == 0 || rest == size + 1) return {0, true, false};
    if (rest <= size) return {rest - 1, false, false};
    return {period - rest - 1, false, true};
}

std::vector<Continuation> continue_axis(int64_t first, int64_t count, int64_t size, WrapMode wrap) {
    std::vector<Continuation> axis;
    axis.reserve(size_t(count));
    const WrapMode mode = wrap == WrapMode::clamp ? WrapMode::mirror : wrap;
    for (int64_t k = first; k < first + count; ++k)
        axis.push_back(wrap == WrapMode::black ? turn_about_outside(k, size)
                                               : Continuation{wrap_index(k, size, mode)});
    return axis;
}

} // namespace

TexelPlane load_plane(const Texture& texels, size_t channel, const SplineForm& form,
                      const TexelRectangle& rectangle, int64_t margin) {
    TexelPlane plane(int64_t(rectangle.x0) - margin, int64_t(rectangle.y0) - margin,
                     int64_t(rectangle.x1) - rectangle.x0 + 1 + 2 * margin,
                     int64_t(rectangle.y1) - rectangle.y0 + 1 + 2 * margin);
    const std::vector<Continuation> columns = continue_axis(plane.x0, plane.width, texels.width, form.wrap),
                                    rows = continue_axis(plane.y0, plane.height, texels.height, form.wrap);
    const float outside = form.outside[channel];
    float* value = plane.values.data();
    for (const Continuation& row : rows)
        for (const Continuation& column : columns) {
            const size_t place = texels.find_texel(size_t(column.index), size_t(row.index));
            float texel = load_value(texels, place + channel);
            if (row.is_turned != column.is_turned) texel = 2 * outside - texel;
            *value++ = row.is_outside || column.is_outside ? outside : texel;
        }
    return plane;
}

} // namespace relief
