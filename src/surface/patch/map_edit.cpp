#include "surface/patch/map_edit.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/check.h"
#include "base/parallel.h"
#include "formulas/mips.h"
#include "image/texel_layout.h"
#include "surface/map/mip_chain.h"
#include "surface/map/texels.h"
#include "surface/map/tile_texels.h"
#include "surface/map/wrapped_range.h"

namespace relief {

namespace {

/// Beyond what fetches reach, bilinear ones or those of a spline, whatever they round to.
constexpr int64_t kSlackTexels = 2, kSmoothSlackTexels = 3;

bool overlaps(const WrappedRange& range, int64_t first, int64_t last) {
    for (int part = 0; part < range.count; ++part)
        if (range.parts[part][0] <= last && range.parts[part][1] >= first) return true;
    return false;
}

bool meet(const TexelRectangle& a, const TexelRectangle& b) {
    return a.x0 <= b.x1 && b.x0 <= a.x1 && a.y0 <= b.y1 && b.y0 <= a.y1;
}

/// Tells whether what lies between some vertices of one tile reads what has changed.
class MapReads {
  public:
    MapReads(const DisplacementMap& map, TileIndex tile, std::span<const TexelRectangle> changed)
        : map_(map), tile_(tile), changed_(changed) {}

    /// In the map itself or in its copy `mip`; `reach` as for find_touched_patches.
    bool is_touched(const Surface& surface, std::span<const uint32_t> vertices, uint32_t mip,
                    float reach) const {
        const uint8_t own = surface.tile(vertices[0]);
        if (own != tile_ && (map_.neighbours.empty() || own >= map_.tiles.size())) return false;
        return is_copy_touched(surface, vertices, 0, reach) ||
               (mip > 0 && is_copy_touched(surface, vertices, mip, reach));
    }

  private:
    bool is_copy_touched(const Surface& surface, std::span<const uint32_t> vertices, uint32_t mip,
                         float reach) const {
        const uint8_t own = surface.tile(vertices[0]);
        const Texture& texture = map_.image(own, mip).texture;
        const TexelRectangle& changed = changed_[std::min(size_t(mip), changed_.size() - 1)];
        double low_x = INFINITY, high_x = -INFINITY, low_y = INFINITY, high_y = -INFINITY;
        for (const uint32_t vertex : vertices) {
            const Vec2f& uv = surface.uvs[vertex];
            const double x = double(uv.x) * texture.width;
            const double y = (map_.flip_v ? double(uv.y) : 1 - double(uv.y)) * texture.height;
            low_x = std::min(low_x, x), high_x = std::max(high_x, x);
            low_y = std::min(low_y, y), high_y = std::max(high_y, y);
        }
        // Uvs that run on are no farther out than the sides are long.
        const double over_x = reach * (high_x - low_x), over_y = reach * (high_y - low_y);
        low_x -= over_x, high_x += over_x, low_y -= over_y, high_y += over_y;
        const std::array columns = extend(low_x, high_x), rows = extend(low_y, high_y);
        if (!map_.neighbours.empty() && !is_within_image(texture, columns, rows))
            return std::ranges::any_of(
                find_tile_ranges(map_, own, mip, columns, rows).parts,
                [&](const TileRange& part) { return part.tile == tile_ && meet(part.texels, changed); });
        return own == tile_ && reads(low_x, high_x, texture.width, changed.x0, changed.x1) &&
               reads(low_y, high_y, texture.height, changed.y0, changed.y1);
    }

    /// Texels that may be read between two places of an axis.
    std::array<int64_t, 2> extend(double low, double high) const {
        const int64_t slack = map_.is_smooth ? kSmoothSlackTexels : kSlackTexels;
        return {int64_t(std::floor(low)) - slack, int64_t(std::ceil(high)) + slack};
    }

    bool reads(double low, double high, int64_t size, int64_t first, int64_t last) const {
        const auto [begin, end] = extend(low, high);
        return overlaps(wrap_range(begin, end, size, map_.wrap), first, last);
    }

    const DisplacementMap& map_;
    TileIndex tile_;
    std::span<const TexelRectangle> changed_;
};

/// The patch itself, and where its edges and corners belong to other vertices, those.
bool is_patch_touched(const Surface& surface, const MapReads& reads, uint32_t patch, float reach) {
    const Quad quad = surface.quads[patch];
    const auto get_mip = [&](uint32_t place) {
        return scalar::packed_mip(surface.packed_mips(patch), place);
    };
    if (reads.is_touched(surface, quad.vertex, get_mip(scalar::kMipInside), reach)) return true;
    const bool has_copies = !surface.mips.empty();
    for (int k = 0; k < 4; ++k) {
        const uint32_t dominant = surface.dominant(quad.vertex[k]);
        if ((has_copies || dominant != quad.vertex[k]) &&
            reads.is_touched(surface, {&dominant, 1}, get_mip(scalar::kMipCorners + uint32_t(k)), reach))
            return true;
        if (!has_copies && !surface.is_seam(patch, k)) continue;
        const Surface::EdgeLine line = surface.edge_line(patch, k);
        const uint32_t ends[] = {line.first, line.second};
        if (reads.is_touched(surface, ends, get_mip(scalar::kMipEdges + uint32_t(k)), reach)) return true;
    }
    return false;
}

} // namespace

void copy_texels(const Texture& source, Texture& target, uint32_t x, uint32_t y) {
    DCHECK(x + source.width <= target.width && y + source.height <= target.height);
    for (uint32_t row = 0; row < source.height; ++row)
        for (uint32_t column = 0; column < source.width; ++column) {
            const std::array<float, 4> texel = read_channels(source, column, row);
            const size_t place = target.find_texel(x + column, y + row);
            for (size_t c = 0; c < target.stride; ++c) store_value(target, place + c, texel[c]);
        }
}

std::vector<uint8_t> find_touched_patches(const Surface& surface, TileIndex tile,
                                          std::span<const TexelRectangle> changed,
                                          std::span<const float> reach) {
    std::vector<uint8_t> touched(surface.patch_count());
    const MapReads reads(surface.map, tile, changed);
    parallel_for("patches of an edit", touched.size(), 1024, [&](size_t begin, size_t end) {
        for (size_t patch = begin; patch < end; ++patch)
            touched[patch] =
                is_patch_touched(surface, reads, uint32_t(patch), reach.empty() ? 0.0f : reach[patch]);
    });
    return touched;
}

} // namespace relief
