#include "surface/map/spline_coefficients.h"

#include <algorithm>

#include "base/parallel.h"
#include "image/texel_layout.h"
#include "surface/map/dequantize.h"
#include "surface/map/texel_plane.h"
#include "surface/map/texels.h"
#include "surface/map/tile_texels.h"

namespace relief {

namespace {

/// The filter that turns values into coefficients falls by 3.7 a texel: what is cut off is below an ulp.
constexpr int64_t kReach = 14;
constexpr uint32_t kSideOfPart = 256; ///< of what is made at once, by one thread

/// Of the inverse of (1 4 1) / 6: sqrt(3) z^|k| with z = sqrt(3) - 2 (Unser 1999, Splines: a perfect fit).
constexpr std::array<float, kReach + 1> make_weights() {
    std::array<float, kReach + 1> weights{};
    double weight = 1.7320508075688772935;
    for (float& result : weights) result = float(weight), weight *= -0.26794919243112270647;
    return weights;
}
constexpr std::array<float, kReach + 1> kWeights = make_weights();

/// Adds up what lies `stride` values apart about each of `count` values.
void filter_values(const float* source, int64_t stride, int64_t count, float* target) {
    for (int64_t k = 0; k < count; ++k) target[k] = kWeights[0] * source[k];
    for (int64_t distance = 1; distance <= kReach; ++distance) {
        const float *low = source - distance * stride, *high = source + distance * stride;
        const float weight = kWeights[size_t(distance)];
        for (int64_t k = 0; k < count; ++k) target[k] += weight * (low[k] + high[k]);
    }
}

/// In place, along x and then along y: what is kReach from the sides is of use afterwards.
void interpolate_plane(TexelPlane& plane) {
    TexelPlane along(plane.x0, plane.y0, plane.width, plane.height);
    const int64_t count = plane.width - 2 * kReach;
    for (int64_t y = plane.y0; y < plane.y0 + plane.height; ++y)
        filter_values(plane.at(plane.x0 + kReach, y), 1, count, along.at(plane.x0 + kReach, y));
    for (int64_t y = plane.y0 + kReach; y < plane.y0 + plane.height - kReach; ++y)
        filter_values(along.at(plane.x0 + kReach, y), plane.width, count, plane.at(plane.x0 + kReach, y));
}

int64_t find_reach(const SplineForm& form) {
    return (form.is_interpolating ? kReach : 0) + (form.is_dequantized ? get_dequantization_reach() : 0);
}

/// Loads values of other tiles outside of the image; the rest of the plane, which continues the image, stays.
/// A tile that ends on the way is continued as load_plane() continues an image, except with WrapMode::black.
void load_other_tiles(const Texture& texels, const TileSurroundings& surroundings, size_t channel,
                      TexelPlane& plane) {
    const int64_t width = texels.width, height = texels.height;
    const DisplacementMap& map = surroundings.map;
    const WrapMode wrap = map.wrap == WrapMode::clamp ? WrapMode::mirror : map.wrap;
    for (int64_t y = plane.y0; y < plane.y0 + plane.height; ++y)
        for (int64_t x = plane.x0; x < plane.x0 + plane.width; ++x) {
            if (x >= 0 && x < width && y >= 0 && y < height) continue;
            TilePlace place = find_tile_place(map, surroundings.tile, x, y, width, height);
            if (place.tile == surroundings.tile) continue;
            place.x = wrap_index(place.x, width, wrap), place.y = wrap_index(place.y, height, wrap);
            if (place.x >= 0 && place.y >= 0)
                *plane.at(x, y) = read_place(map, 0, place, width, height)[channel];
        }
}

/// A computation of coefficients reads these.
struct SplineSource {
    const Texture& texels;
    const SplineForm& form;
    const TileSurroundings* surroundings; ///< or null
};

void compute_rectangle(const SplineSource& source, const TexelRectangle& rectangle, Texture& coefficients) {
    const auto& [texels, form, surroundings] = source;
    const int64_t reach = find_reach(form);
    for (size_t channel = 0; channel < std::min<size_t>(3, texels.channel_count); ++channel) {
        TexelPlane plane = load_plane(texels, channel, form, rectangle, reach);
        if (surroundings) load_other_tiles(texels, *surroundings, channel, plane);
        if (form.is_dequantized) dequantize(plane, get_quantization_step(texels.source_type));
        if (form.is_interpolating) interpolate_plane(plane);
        for (uint32_t y = rectangle.y0; y <= rectangle.y1; ++y)
            for (uint32_t x = rectangle.x0; x <= rectangle.x1; ++x)
                coefficients.floats[coefficients.find_texel(x, y) + channel] = *plane.at(x, y);
    }
}

void compute_coefficients(const SplineSource& source, const TexelRectangle& rectangle,
                          Texture& coefficients) {
    const auto count_parts = [](uint32_t first, uint32_t last) { return (last - first) / kSideOfPart + 1; };
    const size_t columns = count_parts(rectangle.x0, rectangle.x1),
                 rows = count_parts(rectangle.y0, rectangle.y1);
    parallel_for("spline coefficients", columns * rows, 1, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            TexelRectangle part = rectangle;
            part.x0 += uint32_t(k % columns) * kSideOfPart, part.y0 += uint32_t(k / columns) * kSideOfPart;
            part.x1 = std::min(rectangle.x1, part.x0 + kSideOfPart - 1);
            part.y1 = std::min(rectangle.y1, part.y0 + kSideOfPart - 1);
            compute_rectangle(source, part, coefficients);
        }
    });
}

/// Indices that a change of [first, last] reaches; all of them where it reaches over an end that repeats.
std::array<uint32_t, 2> extend(uint32_t first, uint32_t last, uint32_t size, int64_t reach, WrapMode wrap) {
    const int64_t low = int64_t(first) - reach, high = int64_t(last) + reach;
    if (wrap == WrapMode::repeat && (low < 0 || high >= int64_t(size))) return {0, size - 1};
    return {uint32_t(std::max<int64_t>(low, 0)), uint32_t(std::min<int64_t>(high, int64_t(size) - 1))};
}

} // namespace

SplineForm make_spline_form(const Displacement& displacement) {
    const Vec3f& middle = displacement.midlevel;
    const bool is_height = displacement.type == DisplacementType::height;
    SplineForm form;
    form.is_interpolating = displacement.filter == MapFilter::cubic;
    form.is_dequantized = displacement.dequantize && is_smooth(displacement.filter);
    form.wrap = displacement.wrap;
    form.outside = {middle.x, is_height ? 0 : middle.y, is_height ? 0 : middle.z};
    return form;
}

SplineForm make_spline_form(MapFilter filter) {
    SplineForm form;
    form.is_interpolating = filter == MapFilter::cubic;
    form.wrap = WrapMode::repeat;
    return form;
}

std::shared_ptr<const Texture> make_spline(const std::shared_ptr<const Texture>& texels,
                                           const SplineForm& form, const TileSurroundings* surroundings) {
    if (form.keeps_texels()) return texels;
    const TexelRectangle all{0, 0, texels->width - 1, texels->height - 1};
    if (!find_texel_range(*texels, all)) refuse_bad_texel(*texels, all);
    auto coefficients = std::make_shared<Texture>();
    coefficients->width = texels->width, coefficients->height = texels->height;
    coefficients->channel_count = texels->channel_count, coefficients->source_type = texels->source_type;
    coefficients->file = texels->file;
    coefficients->stride = texels->stride;
    coefficients->floats.resize(coefficients->value_count());
    for (size_t k = 3; texels->stride == 4 && k < coefficients->floats.size(); k += 4)
        coefficients->floats[k] = 1;
    compute_coefficients({*texels, form, surroundings}, all, *coefficients);
    return coefficients;
}

TexelRectangle update_spline(const Texture& texels, const SplineForm& form, const TexelRectangle& changed,
                             Texture& coefficients, const TileSurroundings* surroundings) {
    const int64_t reach = find_reach(form);
    const auto columns = extend(changed.x0, changed.x1, texels.width, reach, form.wrap);
    const auto rows = extend(changed.y0, changed.y1, texels.height, reach, form.wrap);
    const TexelRectangle reached{columns[0], rows[0], columns[1], rows[1]};
    compute_coefficients({texels, form, surroundings}, reached, coefficients);
    return reached;
}

std::optional<TexelRectangle> update_spline_beside(const Texture& texels, const SplineForm& form,
                                                   const TexelRectangle& changed, std::array<int, 2> offset,
                                                   Texture& coefficients,
                                                   const TileSurroundings& surroundings) {
    const int64_t reach = find_reach(form), width = texels.width, height = texels.height;
    const auto has_size = [&](const DisplacementMap::Tile& tile) {
        return tile.texture->width == texels.width && tile.texture->height == texels.height;
    };
    TexelRectangle reached{0, 0, texels.width - 1, texels.height - 1};
    if (std::ranges::all_of(surroundings.map.tiles, has_size)) {
        const int64_t x0 = std::max<int64_t>(int64_t(changed.x0) + offset[0] * width - reach, 0),
                      x1 = std::min(int64_t(changed.x1) + offset[0] * width + reach, width - 1),
                      y0 = std::max<int64_t>(int64_t(changed.y0) + offset[1] * height - reach, 0),
                      y1 = std::min(int64_t(changed.y1) + offset[1] * height + reach, height - 1);
        if (x0 > x1 || y0 > y1) return std::nullopt;
        reached = {uint32_t(x0), uint32_t(y0), uint32_t(x1), uint32_t(y1)};
    }
    compute_coefficients({texels, form, &surroundings}, reached, coefficients);
    return reached;
}

} // namespace relief
