#include "analysis/map_on_plane.h"

#include <algorithm>
#include <cmath>

#include "math/vec.h"
#include "surface/map/texels.h"

namespace relief {

namespace {

Vec3f decode(const Texture& texture, const AxisMap& axes, const Vec3f& scale, uint32_t x, uint32_t y) {
    const std::array<float, 3> texel = read_texel(texture, x, y);
    Vec3f d;
    for (size_t c = 0; c < 3; ++c)
        set_component(d, axes.axis[c], texel[c] * get_component(scale, int(c)) * float(axes.sign[c]));
    return d;
}

} // namespace

PlaneFolds measure_folds(const Displacement& map, const AxisMap& axes) {
    constexpr double kMostCells = 1 << 20;
    constexpr float kSide = 2;
    const Texture& texture = *map.tiles.front().texture;
    const Vec3f& scale = map.scale;
    PlaneFolds folds;
    // Neighbours of 8 bits differ by whole steps, which would fold by themselves.
    const uint32_t span = texture.source_type == SampleType::uint8 ? 4 : 1;
    if (texture.width <= span || texture.height <= span) return folds;
    const double all = double(texture.width - span) * double(texture.height - span);
    const auto step = uint32_t(std::max(1.0, std::ceil(std::sqrt(all / kMostCells))));
    // Rows run against v.
    const float per_u = float(texture.width) / (kSide * float(span));
    const float per_v = float(texture.height) / (kSide * float(span)) * (map.flip_v ? -1.0f : 1.0f);
    uint64_t count = 0, folded = 0;
    for (uint32_t y = 0; y + span < texture.height; y += step)
        for (uint32_t x = 0; x + span < texture.width; x += step) {
            const Vec3f d = decode(texture, axes, scale, x, y);
            const Vec3f du = (decode(texture, axes, scale, x + span, y) - d) * per_u + Vec3f{1, 0, 0};
            const Vec3f dv = (d - decode(texture, axes, scale, x, y + span)) * per_v + Vec3f{0, 1, 0};
            const Vec3f normal = cross(du, dv);
            if (!is_finite(normal)) continue;
            ++count;
            folded += normal.z < 0;
            folds.area += double(length(normal));
        }
    if (count == 0) return folds;
    folds.share = double(folded) / double(count);
    folds.area /= double(count);
    return folds;
}

} // namespace relief
