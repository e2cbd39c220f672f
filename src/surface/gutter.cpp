#include "surface/gutter.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "surface/texels.h"

namespace relief {

namespace {

constexpr uint32_t kProbes = 64;          ///< a side: texels looked at before anything is worked out
constexpr uint32_t kFewestAlike = 40;     ///< of them, about one in a hundred: less is no background
constexpr double kStep = 0.125;           ///< texels between two points of a border
constexpr double kCoverTolerance = 1e-3;  ///< texels
constexpr double kMostTexelsAcross = 1e5; ///< of one face; beyond, its uvs are no picture of an island

using Point = Vec2<double>;

/// Raw bits of a texel's first three channels.
using TexelBits = std::array<uint32_t, 3>;

struct TexelHash {
    size_t operator()(const TexelBits& bits) const {
        uint64_t hash = 0;
        for (const uint32_t word : bits) hash = (hash ^ word) * 0x9e3779b97f4a7c15ull, hash ^= hash >> 31;
        return size_t(hash);
    }
};

TexelBits get_bits(const Texture& texture, uint32_t x, uint32_t y) {
    const std::array<float, 3> texel = read_texel(texture, x, y);
    TexelBits bits;
    for (size_t c = 0; c < 3; ++c) bits[c] = std::bit_cast<uint32_t>(texel[c] + 0.0f); // -0 is 0
    return bits;
}

/// Counts values and knows the most frequent one.
class Census {
  public:
    void add(const TexelBits& bits) {
        const uint32_t count = ++counts_[bits];
        if (count > most_) most_ = count, value_ = bits;
    }
    uint32_t most() const { return most_; }
    const TexelBits& value() const { return value_; }

  private:
    std::unordered_map<TexelBits, uint32_t, TexelHash> counts_;
    uint32_t most_ = 0;
    TexelBits value_{};
};

/// A map that is baked all over has hardly two texels alike.
bool may_have_background(const Texture& texture) {
    const auto probe = [](uint32_t k, uint32_t size) {
        return uint32_t(uint64_t(size) * (2 * k + 1) / (2 * kProbes));
    };
    Census census;
    for (uint32_t j = 0; j < kProbes; ++j)
        for (uint32_t i = 0; i < kProbes; ++i)
            census.add(get_bits(texture, probe(i, texture.width), probe(j, texture.height)));
    return census.most() >= kFewestAlike;
}

/// A bit a texel.
class TexelMask {
  public:
    explicit TexelMask(const Texture& texture)
        : width_(texture.width), words_((size_t(texture.width) * texture.height + 63) / 64) {}
    void set(int64_t x, int64_t y) { words_[find(x, y) >> 6] |= uint64_t(1) << (find(x, y) & 63); }
    bool has(int64_t x, int64_t y) const { return (words_[find(x, y) >> 6] >> (find(x, y) & 63) & 1) != 0; }

  private:
    size_t find(int64_t x, int64_t y) const { return size_t(y) * width_ + size_t(x); }
    size_t width_;
    std::vector<uint64_t> words_;
};

/// The faces of some meshes on one tile, as polygons counted in texels, row 0 at the top.
class Islands {
  public:
    Islands(const Displacement& displacement, const MapTile& tile)
        : displacement_(displacement), udim_(tile.udim), texture_(*tile.texture) {}

    void add(const Mesh& mesh) {
        std::vector<Edge> edges;
        std::unordered_map<uint64_t, uint64_t> ids; // of places, by their bits
        size_t first = 0;
        for (const uint32_t size : mesh.face_sizes) {
            if (first + size > mesh.uv_indices.size()) break;
            add_face(mesh, first, size, ids, edges);
            first += size;
        }
        std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.key < b.key; });
        for (size_t k = 0; k < edges.size(); ++k) {
            const bool is_shared = (k > 0 && edges[k - 1].key == edges[k].key) ||
                                   (k + 1 < edges.size() && edges[k + 1].key == edges[k].key);
            if (!is_shared) borders_.push_back(edges[k].ends);
        }
    }

    const std::vector<std::pair<Point, Point>>& borders() const { return borders_; }

    /// Calls `visit` with the corners of every face.
    template <class Visit> void visit_faces(const Visit& visit) const {
        for (size_t k = 0; k + 1 < starts_.size(); ++k)
            visit(std::span<const Point>(corners_.data() + starts_[k], starts_[k + 1] - starts_[k]));
    }

  private:
    struct Edge {
        std::pair<uint64_t, uint64_t> key;
        std::pair<Point, Point> ends;
    };

    void add_face(const Mesh& mesh, size_t first, uint32_t size, std::unordered_map<uint64_t, uint64_t>& ids,
                  std::vector<Edge>& edges) {
        Point middle{};
        for (size_t k = first; k < first + size; ++k) {
            if (mesh.uv_indices[k] >= mesh.uvs.size()) return;
            const Vec2f& uv = mesh.uvs[mesh.uv_indices[k]];
            middle = {middle.x + double(uv.x) / size, middle.y + double(uv.y) / size};
        }
        if (!(std::fabs(middle.x) < kMostTexelsAcross && std::fabs(middle.y) < kMostTexelsAcross)) return;
        Point offset{};
        if (displacement_.is_udim) {
            offset = {std::floor(middle.x), std::floor(middle.y)};
            if (offset.x < 0 || offset.x > 9 || 1001 + offset.x + 10 * offset.y != udim_) return;
        }
        std::vector<uint64_t> face_ids;
        const size_t start = corners_.size();
        for (size_t k = first; k < first + size; ++k) {
            const Vec2f& uv = mesh.uvs[mesh.uv_indices[k]];
            const uint64_t bits =
                uint64_t(std::bit_cast<uint32_t>(uv.x + 0.0f)) << 32 | std::bit_cast<uint32_t>(uv.y + 0.0f);
            face_ids.push_back(ids.try_emplace(bits, ids.size()).first->second);
            const double v = double(uv.y) - offset.y;
            corners_.push_back({(double(uv.x) - offset.x) * texture_.width,
                                (displacement_.flip_v ? v : 1 - v) * texture_.height});
        }
        starts_.push_back(corners_.size());
        for (size_t k = 0; k < size; ++k) {
            const size_t next = (k + 1) % size;
            edges.push_back(
                {std::minmax(face_ids[k], face_ids[next]), {corners_[start + k], corners_[start + next]}});
        }
    }

    const Displacement& displacement_;
    const int udim_;
    const Texture& texture_;
    std::vector<size_t> starts_{0};
    std::vector<Point> corners_;
    std::vector<std::pair<Point, Point>> borders_;
};

bool is_near_edge(const Point& a, const Point& b, const Point& p) {
    const Point along{b.x - a.x, b.y - a.y}, to{p.x - a.x, p.y - a.y};
    const double size = along.x * along.x + along.y * along.y;
    const double s = size > 0 ? std::clamp((to.x * along.x + to.y * along.y) / size, 0.0, 1.0) : 0;
    return std::hypot(to.x - s * along.x, to.y - s * along.y) <= kCoverTolerance;
}

/// Inside or on the edge of a polygon (crossings of a ray along x; Shimrat 1962).
bool is_covered(std::span<const Point> face, const Point& p) {
    bool is_inside = false;
    for (size_t k = 0, last = face.size() - 1; k < face.size(); last = k++) {
        const Point &a = face[last], &b = face[k];
        if (is_near_edge(a, b, p)) return true;
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y))
            is_inside = !is_inside;
    }
    return is_inside;
}

/// Works out the gutter of one texture.
class GutterFinder {
  public:
    GutterFinder(const Texture& texture, WrapMode wrap, const Islands& islands)
        : texture_(texture), wrap_(wrap), read_(texture), near_(texture), covered_(texture) {
        for (const auto& [a, b] : islands.borders()) mark_border(a, b);
        islands.visit_faces([&](std::span<const Point> face) { cover(face); });
    }

    GutterFill run() const {
        std::vector<std::array<uint32_t, 2>> gutter;
        Census census;
        for (uint32_t y = 0; y < texture_.height; ++y)
            for (uint32_t x = 0; x < texture_.width; ++x) {
                if (!read_.has(x, y) || covered_.has(x, y)) continue;
                gutter.push_back({x, y});
                census.add(get_bits(texture_, x, y));
            }
        GutterFill fill;
        if (2 * size_t(census.most()) <= gutter.size()) return fill;
        fill.background = census.value();
        for (const auto& [x, y] : gutter) add_nearest(x, y, fill);
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
        const double size = std::hypot(b.x - a.x, b.y - a.y);
        if (!(size < kMostTexelsAcross)) return;
        const int count = int(std::ceil(size / kStep)) + 1;
        constexpr int64_t kReach = GutterFill::kReach;
        for (int k = 0; k <= count; ++k) {
            const double s = double(k) / count;
            const auto x = int64_t(std::floor(a.x + (b.x - a.x) * s - 0.5));
            const auto y = int64_t(std::floor(a.y + (b.y - a.y) * s - 0.5));
            for (int64_t row = y; row <= y + 1; ++row)
                for (int64_t column = x; column <= x + 1; ++column)
                    visit_texel(column, row, [&](int64_t i, int64_t j) { read_.set(i, j); });
            for (int64_t row = y - kReach; row <= y + 1 + kReach; ++row)
                for (int64_t column = x - kReach; column <= x + 1 + kReach; ++column)
                    visit_texel(column, row, [&](int64_t i, int64_t j) { near_.set(i, j); });
        }
    }

    void cover(std::span<const Point> face) {
        Point low = face[0], high = face[0];
        for (const Point& p : face) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
        if (!(high.x - low.x < kMostTexelsAcross && high.y - low.y < kMostTexelsAcross)) return;
        for (auto y = int64_t(std::floor(low.y - 0.5)); double(y) <= high.y; ++y)
            for (auto x = int64_t(std::floor(low.x - 0.5)); double(x) <= high.x; ++x)
                visit_texel(x, y, [&](int64_t i, int64_t j) {
                    if (near_.has(i, j) && !covered_.has(i, j) &&
                        is_covered(face, {double(x) + 0.5, double(y) + 0.5}))
                        covered_.set(i, j);
                });
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

    const Texture& texture_;
    const WrapMode wrap_;
    TexelMask read_;    ///< by points of borders
    TexelMask near_;    ///< to those: of these it is known whether they are covered
    TexelMask covered_; ///< the centre lies in a face
};

void copy_texel(Texture& texture, const GutterFill::Copy& copy) {
    const size_t from = 4 * (size_t(copy.from_y) * texture.width + copy.from_x);
    const size_t to = 4 * (size_t(copy.to_y) * texture.width + copy.to_x);
    for (size_t c = 0; c < 3; ++c) {
        if (texture.halves.empty())
            texture.floats[to + c] = texture.floats[from + c];
        else
            texture.halves[to + c] = texture.halves[from + c];
    }
}

} // namespace

void GutterFill::apply(Texture& texture) {
    for (Copy& copy : copies) {
        copy.is_done = get_bits(texture, copy.to_x, copy.to_y) == background;
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
        if (is_new) copy.is_done = get_bits(texture, copy.to_x, copy.to_y) == background;
        if (!copy.is_done || !(is_new || holds(copy.from_x, copy.from_y))) continue;
        copy_texel(texture, copy);
        all = {std::min(all.x0, copy.to_x), std::min(all.y0, copy.to_y), std::max(all.x1, copy.to_x),
               std::max(all.y1, copy.to_y)};
    }
    return all;
}

GutterFill find_gutter(const Displacement& displacement, const MapTile& tile,
                       std::span<const Mesh* const> meshes) {
    if (!may_have_background(*tile.texture)) return {};
    Islands islands(displacement, tile);
    for (const Mesh* mesh : meshes) islands.add(*mesh);
    return GutterFinder(*tile.texture, displacement.wrap, islands).run();
}

} // namespace relief
