// One channel over a rectangle of texels that may reach beyond the image, for filters that run over it.
#pragma once

#include <cstdint>
#include <vector>

#include "surface/map/spline_coefficients.h"

namespace relief {

struct TexelPlane {
    int64_t x0 = 0, y0 = 0, width = 0, height = 0;
    std::vector<float> values;

    TexelPlane(int64_t left, int64_t top, int64_t columns, int64_t rows)
        : x0(left), y0(top), width(columns), height(rows), values(size_t(columns * rows)) {}
    /// Values from column `x`, row `y` of the image on.
    float* at(int64_t x, int64_t y) { return values.data() + (y - y0) * width + (x - x0); }
    const float* at(int64_t x, int64_t y) const { return values.data() + (y - y0) * width + (x - x0); }
};

/// `rectangle` and `margin` texels about it, continued by the form's wrap mode: mirrored for
/// WrapMode::clamp, so that the first coefficient outside equals the last inside, as it is read; turned about
/// the outside's value for WrapMode::black, so that it equals that.
TexelPlane load_plane(const Texture& texels, size_t channel, const SplineForm& form,
                      const TexelRectangle& rectangle, int64_t margin);

} // namespace relief
