// The faces of meshes in the plane of their uvs, counted in texels of one image: what of a map is used.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "relief/scene.h"

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

/// A bit a texel.
class TexelMask {
  public:
    TexelMask() = default;
    explicit TexelMask(const Texture& texture)
        : width_(texture.width), words_((size_t(texture.width) * texture.height + 63) / 64) {}
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

/// The faces of some meshes on one tile, as polygons counted in texels, row 0 at the top.
class UvIslands {
  public:
    using Point = Vec2<double>;
    static constexpr double kMostTexelsAcross = 1e5; ///< of one face; beyond, its uvs are no picture

    UvIslands(const Displacement& displacement, const MapTile& tile)
        : displacement_(displacement), udim_(tile.udim), texture_(*tile.texture) {}

    /// Faces with indices out of range are left out.
    void add(const Mesh& mesh);

    /// Edges that belong to one face only.
    const std::vector<std::pair<Point, Point>>& borders() const { return borders_; }

    /// Calls `visit(x, y)` for each texel, anywhere in the plane, whose centre lies in a face or on its edge
    /// and that `is_wanted(x, y)`.
    template <class Wanted, class Visit>
    void visit_covered(const Wanted& is_wanted, const Visit& visit) const {
        for (size_t k = 0; k + 1 < starts_.size(); ++k) {
            const std::span<const Point> face(corners_.data() + starts_[k], starts_[k + 1] - starts_[k]);
            const auto [low, high] = find_ends(face);
            if (!(high.x - low.x < kMostTexelsAcross && high.y - low.y < kMostTexelsAcross)) continue;
            for (auto y = int64_t(std::floor(low.y - 0.5)); double(y) <= high.y; ++y)
                for (auto x = int64_t(std::floor(low.x - 0.5)); double(x) <= high.x; ++x)
                    if (is_wanted(x, y) && is_covered(face, {double(x) + 0.5, double(y) + 0.5})) visit(x, y);
        }
    }

  private:
    struct Edge {
        std::pair<uint64_t, uint64_t> key;
        std::pair<Point, Point> ends;
    };

    void add_face(const Mesh& mesh, size_t first, uint32_t size, std::unordered_map<uint64_t, uint64_t>& ids,
                  std::vector<Edge>& edges);
    static std::pair<Point, Point> find_ends(std::span<const Point> face);
    static bool is_covered(std::span<const Point> face, const Point& p);

    const Displacement& displacement_;
    const int udim_;
    const Texture& texture_;
    std::vector<size_t> starts_{0};
    std::vector<Point> corners_;
    std::vector<std::pair<Point, Point>> borders_;
};

} // namespace relief
