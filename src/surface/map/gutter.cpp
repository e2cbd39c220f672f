#include "surface/map/gutter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>

#include "math/vec_double.h"
#include "surface/map/texels.h"
#include "surface/mesh/uv_islands.h"

namespace relief {

namespace {

constexpr double kStep = 0.125;        ///< texels between two points of a border
constexpr double kLongestBorder = 1e5; ///< texels of one edge; beyond, its uvs are no picture of an island

using Point = UvIslands::Point;

/// Works out the gutter of one texture.
class GutterFinder {
  public:
    GutterFinder(const Texture& texture, WrapMode wrap, const UvIslands& islands)
        : texture_(texture), wrap_(wrap), read_(texture), near_(texture), covered_(texture) {
        for (const auto& [a, b] : islands.borders()) mark_border(a, b);
        const auto is_open = [&](int64_t x, int64_t y) {
            bool is_open = false;
            visit_texel(x, y,
                        [&](int64_t i, int64_t j) { is_open = near_.has(i, j) && !covered_.has(i, j); });
            return is_open;
        };
        islands.visit_covered(is_open, [&](int64_t x, int64_t y) {
            visit_texel(x, y, [&](int64_t i, int64_t j) { covered_.set(i, j); });
        });
    }

    /// `spread`: texels beyond those that bilinear fetches read.
    GutterFill run(int spread) const {
        std::vector<std::array<uint32_t, 2>> gutter;
        TexelCensus census;
        for (uint32_t y = 0; y < texture_.height; ++y)
            for (uint32_t x = 0; x < texture_.width; ++x) {
                if (!read_.has(x, y) || covered_.has(x, y)) continue;
                gutter.push_back({x, y});
                census.add(get_texel_bits(texture_, x, y));
            }
        GutterFill fill;
        if (2 * size_t(census.most()) <= gutter.size()) return fill;
        fill.background = census.value();
        for (const auto& [x, y] : gutter) add_nearest(x, y, fill);
        if (spread > 0) extend(spread, fill);
        return fill;
    }

  private:
    /// Calls `visit` with the texel that (x, y), anywhere, reads.
    template <class Visit> void visit_texel(int64_t x, int64_t y, const Visit& visit) const {
        const int64_t column = wrap_index(x, texture_.width, wrap_),
                      row = wrap_index(y, texture_.height, wrap_);
        if (column >= 0 && row >= 0) visit(column, row);
    }

    void mark_border(const Point& a, const Point& b) {
        const double size = compute_length(b.x - a.x, b.y - a.y);
        if (!(size < kLongestBorder)) return;
        const int count = int(std::ceil(size / kStep)) + 1;
        constexpr int64_t kReach = GutterFill::kReach;
        int64_t last_x = 0, last_y = 0;
        for (int k = 0; k <= count; ++k) {
            const double s = double(k) / count;
            const auto x = int64_t(std::floor(a.x + (b.x - a.x) * s - 0.5));
            const auto y = int64_t(std::floor(a.y + (b.y - a.y) * s - 0.5));
            if (k > 0 && x == last_x && y == last_y) continue;
            last_x = x, last_y = y;
            for (int64_t row = y; row <= y + 1; ++row)
                for (int64_t column = x; column <= x + 1; ++column)
                    visit_texel(column, row, [&](int64_t i, int64_t j) { read_.set(i, j); });
            for (int64_t row = y - kReach; row <= y + 1 + kReach; ++row)
                for (int64_t column = x - kReach; column <= x + 1 + kReach; ++column)
                    visit_texel(column, row, [&](int64_t i, int64_t j) { near_.set(i, j); });
        }
    }

    void add_nearest(uint32_t x, uint32_t y, GutterFill& fill) const {
        constexpr int64_t kReach = GutterFill::kReach;
        int64_t best = 2 * kReach * kReach + 1;
        GutterFill::Copy copy{x, y, x, y, false};
        for (int64_t dy = -kReach; dy <= kReach; ++dy)
            for (int64_t dx = -kReach; dx <= kReach; ++dx)
                visit_texel(x + dx, y + dy, [&](int64_t i, int64_t j) {
                    if (dx * dx + dy * dy >= best || !near_.has(i, j) || !covered_.has(i, j)) return;
                    best = dx * dx + dy * dy;
                    copy.from_x = uint32_t(i), copy.from_y = uint32_t(j);
                });
        if (copy.from_x != x || copy.from_y != y) fill.copies.push_back(copy);
    }

    /// Further texels outside, ring by ring, each with the value of the nearest one that a neighbour has. A
    /// ring does not pass an island: what is known to be covered lies all along its border.
    void extend(int spread, GutterFill& fill) const {
        struct Front {
            int64_t x, y, to_x, to_y; ///< in the image; from there to the texel that its value is from
        };
        std::vector<Front> front;
        TexelMask taken(texture_);
        for (const GutterFill::Copy& copy : fill.copies) {
            taken.set(copy.to_x, copy.to_y);
            front.push_back({copy.to_x, copy.to_y, find_step(copy.to_x, copy.from_x, texture_.width),
                             find_step(copy.to_y, copy.from_y, texture_.height)});
        }
        for (int ring = 0; ring < spread; ++ring) {
            std::map<std::array<int64_t, 2>, Front> next; // by row, so that texels come in a fixed order
            for (const Front& from : front)
                for (int64_t dy = -1; dy <= 1; ++dy)
                    for (int64_t dx = -1; dx <= 1; ++dx)
                        visit_texel(from.x + dx, from.y + dy, [&](int64_t x, int64_t y) {
                            if (taken.has(x, y) || covered_.has(x, y)) return;
                            const Front candidate{x, y, from.to_x - dx, from.to_y - dy};
                            const auto [place, is_new] = next.try_emplace({y, x}, candidate);
                            Front& best = place->second;
                            if (!is_new && candidate.to_x * candidate.to_x + candidate.to_y * candidate.to_y <
                                               best.to_x * best.to_x + best.to_y * best.to_y)
                                best = candidate;
                        });
            front.clear();
            for (const auto& [place, reached] : next) {
                const Front& at = reached;
                taken.set(at.x, at.y);
                front.push_back(at);
                visit_texel(at.x + at.to_x, at.y + at.to_y, [&](int64_t x, int64_t y) {
                    fill.copies.push_back({uint32_t(at.x), uint32_t(at.y), uint32_t(x), uint32_t(y)});
                });
            }
        }
    }

    /// From one index to another the shorter way, where the map repeats.
    int64_t find_step(uint32_t from, uint32_t to, uint32_t size) const {
        const int64_t step = int64_t(to) - from;
        if (wrap_ != WrapMode::repeat || 2 * std::abs(step) <= int64_t(size)) return step;
        return step > 0 ? step - size : step + size;
    }

    const Texture& texture_;
    const WrapMode wrap_;
    TexelMask read_;    ///< by points of borders
    TexelMask near_;    ///< to those: of these it is known whether they are covered
    TexelMask covered_; ///< the centre lies in a face
};

void copy_texel(Texture& texture, const GutterFill::Copy& copy) {
    const size_t from = texture.find_texel(copy.from_x, copy.from_y);
    copy_values(texture, from, texture, texture.find_texel(copy.to_x, copy.to_y),
                std::min(3u, texture.stride));
}

} // namespace

void GutterFill::apply(Texture& texture) {
    for (Copy& copy : copies) {
        copy.is_done = get_texel_bits(texture, copy.to_x, copy.to_y) == background;
        if (copy.is_done) copy_texel(texture, copy);
    }
}

TexelRectangle GutterFill::follow(Texture& texture, const TexelRectangle& changed) {
    const auto holds = [&](uint32_t x, uint32_t y) {
        return x >= changed.x0 && x <= changed.x1 && y >= changed.y0 && y <= changed.y1;
    };
    TexelRectangle all = changed;
    for (Copy& copy : copies) {
        const bool is_new = holds(copy.to_x, copy.to_y);
        if (is_new) copy.is_done = get_texel_bits(texture, copy.to_x, copy.to_y) == background;
        if (!copy.is_done || !(is_new || holds(copy.from_x, copy.from_y))) continue;
        copy_texel(texture, copy);
        all = {std::min(all.x0, copy.to_x), std::min(all.y0, copy.to_y), std::max(all.x1, copy.to_x),
               std::max(all.y1, copy.to_y)};
    }
    return all;
}

GutterFill find_gutter(const Displacement& displacement, const MapTile& tile,
                       std::span<const UvOutlines* const> meshes) {
    if (!may_have_background(*tile.texture)) return {};
    UvIslands islands(displacement, tile);
    for (const UvOutlines* mesh : meshes) islands.add(*mesh);
    if (islands.is_all_covered()) return {};
    const int spread = displacement.filter == MapFilter::cubic     ? GutterFill::kCubicSpread
                       : displacement.filter == MapFilter::bspline ? GutterFill::kSplineSpread
                                                                   : 0;
    return GutterFinder(*tile.texture, displacement.wrap, islands).run(spread);
}

} // namespace relief
