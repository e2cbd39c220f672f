// The faces of meshes in the plane of their uvs, counted in texels of one image, which show the used part of
// a map.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "relief/scene.h"
#include "surface/mesh/uv_outlines.h"

namespace relief {

/// Bits of a texel's first three channels, as floats; -0 is 0.
using TexelBits = std::array<uint32_t, 3>;
TexelBits get_texel_bits(const Texture& texture, uint32_t x, uint32_t y);

/// Counts values of texels and knows the most frequent one.
class TexelCensus {
  public:
    void add(const TexelBits& bits) {
        const uint32_t count = ++counts_[bits];
        if (count > most_) most_ = count, value_ = bits;
    }
    uint32_t most() const { return most_; }
    const TexelBits& value() const { return value_; }

  private:
    struct Hash {
        size_t operator()(const TexelBits& bits) const;
    };
    std::unordered_map<TexelBits, uint32_t, Hash> counts_;
    uint32_t most_ = 0;
    TexelBits value_{};
};

/// Looks at a few thousand texels: a map that is baked all over has hardly two alike.
bool may_have_background(const Texture& texture);

/// One bit per texel.
class TexelMask {
  public:
    TexelMask() = default;
    explicit TexelMask(const Texture& texture, bool value = false)
        : width_(texture.width),
          words_((size_t(texture.width) * texture.height + 63) / 64, value ? ~uint64_t(0) : 0) {}
    bool is_empty() const { return words_.empty(); }
    void set(int64_t x, int64_t y, bool value = true) {
        const uint64_t bit = uint64_t(1) << (find(x, y) & 63);
        uint64_t& word = words_[find(x, y) >> 6];
        word = value ? word | bit : word & ~bit;
    }
    bool has(int64_t x, int64_t y) const { return (words_[find(x, y) >> 6] >> (find(x, y) & 63) & 1) != 0; }
    size_t byte_count() const { return words_.size() * sizeof(uint64_t); }

  private:
    size_t find(int64_t x, int64_t y) const { return size_t(y) * width_ + size_t(x); }
    size_t width_ = 0;
    std::vector<uint64_t> words_;
};

/// The faces of some meshes on one tile, in texels, row 0 at the top; patches where uvs are subdivided.
class UvIslands {
  public:
    using Point = Vec2<double>;
    UvIslands(const Displacement& displacement, const MapTile& tile)
        : displacement_(displacement), udim_(tile.udim), texture_(*tile.texture) {}

    /// Adds the faces of a mesh.
    void add(const UvOutlines& outlines);

    /// Some face runs over a map that repeats more than once, so that nothing of it is outside.
    bool is_all_covered() const { return is_all_covered_; }

    /// Edges that belong to one face only.
    const std::vector<std::pair<Point, Point>>& borders() const { return borders_; }

    /// Calls `visit(x, y)` for each texel that `is_wanted(x, y)` whose centre lies in a face or on its edge.
    template <class Wanted, class Visit>
    void visit_covered(const Wanted& is_wanted, const Visit& visit) const {
        for (size_t k = 0; k + 1 < starts_.size(); ++k) {
            const std::span<const Point> face(corners_.data() + starts_[k], starts_[k + 1] - starts_[k]);
            const auto [low, high] = find_ends(face);
            const auto [first_x, last_x] = find_range(low.x, high.x, texture_.width);
            const auto [first_y, last_y] = find_range(low.y, high.y, texture_.height);
            for (int64_t y = first_y; y <= last_y; ++y)
                for (int64_t x = first_x; x <= last_x; ++x)
                    if (is_wanted(x, y) && is_covered(face, {double(x) + 0.5, double(y) + 0.5})) visit(x, y);
        }
    }

  private:
    struct Edge {
        uint64_t low, high; ///< uvs of its ends as keys, the smaller one first
        size_t from, to;    ///< in `corners_`
        bool is_shared = false;
        bool joins_same(const Edge& other) const { return low == other.low && high == other.high; }
    };

    void add_face(std::span<const Vec2f> uvs, std::vector<Edge>& edges);
    static void mark_shared(std::span<Edge> edges);
    bool repeats() const {
        return displacement_.wrap == WrapMode::repeat || displacement_.wrap == WrapMode::mirror;
    }
    /// Texels whose centres may lie between two places; beside a map that does not repeat one is enough.
    std::array<int64_t, 2> find_range(double low, double high, uint32_t size) const;
    static std::pair<Point, Point> find_ends(std::span<const Point> face);
    static bool is_covered(std::span<const Point> face, const Point& p);

    const Displacement& displacement_;
    const int udim_;
    const Texture& texture_;
    bool is_all_covered_ = false;
    std::vector<size_t> starts_{0};
    std::vector<Point> corners_;
    std::vector<std::pair<Point, Point>> borders_;
};

} // namespace relief
