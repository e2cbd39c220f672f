#include "surface/mesh/uv_islands.h"

#include <algorithm>
#include <bit>

#include "base/stop_request.h"
#include "base/udim.h"
#include "math/vec_double.h"
#include "scene/tile_use.h"
#include "surface/map/texels.h"

namespace relief {

namespace {

using Point = UvIslands::Point;

constexpr uint32_t kProbes = 64;         ///< texels per side that are looked at before anything is computed
constexpr uint32_t kFewestAlike = 40;    ///< of them, about one in a hundred: less is no background
constexpr double kCoverTolerance = 1e-3; ///< texels
constexpr size_t kFacesALook = 1024;     ///< at whether the work is to stop
constexpr double kFarthest = 1e9;        ///< texels; beyond, uvs name no texel

bool is_near_edge(const Point& a, const Point& b, const Point& p) {
    const Point along{b.x - a.x, b.y - a.y}, to{p.x - a.x, p.y - a.y};
    const double size = along.x * along.x + along.y * along.y;
    const double s = size > 0 ? std::clamp((to.x * along.x + to.y * along.y) / size, 0.0, 1.0) : 0;
    return compute_length(to.x - s * along.x, to.y - s * along.y) <= kCoverTolerance;
}

/// Equal places have equal bits: -0 counts as 0.
uint64_t get_place_bits(const Vec2f& uv) {
    return uint64_t(std::bit_cast<uint32_t>(uv.x + 0.0f)) << 32 | std::bit_cast<uint32_t>(uv.y + 0.0f);
}

uint64_t mix_bits(uint64_t bits) {
    bits = (bits ^ bits >> 32) * 0x9e3779b97f4a7c15ull;
    return bits ^ bits >> 29;
}

} // namespace

TexelBits get_texel_bits(const Texture& texture, uint32_t x, uint32_t y) {
    const std::array<float, 3> texel = read_texel(texture, x, y);
    TexelBits bits;
    for (size_t c = 0; c < 3; ++c) bits[c] = std::bit_cast<uint32_t>(texel[c] + 0.0f);
    return bits;
}

size_t TexelCensus::Hash::operator()(const TexelBits& bits) const {
    uint64_t hash = 0;
    for (const uint32_t word : bits) hash = (hash ^ word) * 0x9e3779b97f4a7c15ull, hash ^= hash >> 31;
    return size_t(hash);
}

bool may_have_background(const Texture& texture) {
    const auto probe = [](uint32_t k, uint32_t size) {
        return uint32_t(uint64_t(size) * (2 * k + 1) / (2 * kProbes));
    };
    TexelCensus census;
    for (uint32_t j = 0; j < kProbes; ++j)
        for (uint32_t i = 0; i < kProbes; ++i)
            census.add(get_texel_bits(texture, probe(i, texture.width), probe(j, texture.height)));
    return census.most() >= kFewestAlike;
}

void UvIslands::add(const UvOutlines& outlines) {
    std::vector<Edge> edges;
    edges.reserve(outlines.uvs.size());
    if (corners_.empty()) corners_.reserve(outlines.uvs.size()); // each later mesh would copy it
    for (size_t face = 0; face < outlines.face_count(); ++face) add_face(outlines.face(face), edges);
    mark_shared(edges);
    for (const Edge& edge : edges)
        if (!edge.is_shared) borders_.push_back({corners_[edge.from], corners_[edge.to]});
}

void UvIslands::add_face(std::span<const Vec2f> uvs, std::vector<Edge>& edges) {
    if (starts_.size() % kFacesALook == 0) stop_if_asked();
    Point offset{};
    if (displacement_.is_udim) {
        const UdimSquare square = find_udim_square(udim_);
        offset = {double(square.column), double(square.row)};
        const TileSpan span = find_tile_span(uvs);
        if (!(span.column0 <= offset.x && offset.x <= span.column1 && span.row0 <= offset.y &&
              offset.y <= span.row1))
            return;
    }
    const size_t size = uvs.size(), start = corners_.size();
    for (const Vec2f& uv : uvs) {
        const double v = double(uv.y) - offset.y;
        corners_.push_back({(double(uv.x) - offset.x) * texture_.width,
                            (displacement_.flip_v ? v : 1 - v) * texture_.height});
    }
    const auto [low, high] = find_ends({corners_.data() + start, size});
    const double width = high.x - low.x, height = high.y - low.y;
    const bool is_far = !(std::fabs(low.x) + std::fabs(high.x) < kFarthest &&
                          std::fabs(low.y) + std::fabs(high.y) < kFarthest);
    if (repeats() && (is_far || width > 2.0 * texture_.width || height > 2.0 * texture_.height))
        is_all_covered_ = true;
    if (is_far) {
        corners_.resize(start);
        return;
    }
    starts_.push_back(corners_.size());
    const uint64_t first = get_place_bits(uvs[0]);
    uint64_t last = first;
    for (size_t k = 0; k < size; ++k) {
        const size_t next = k + 1 < size ? k + 1 : 0;
        const uint64_t bits = next == 0 ? first : get_place_bits(uvs[next]);
        edges.push_back({std::min(last, bits), std::max(last, bits), start + k, start + next});
        last = bits;
    }
}

/// Uses a hash table with open addressing, which has at least twice as many entries as there are edges.
void UvIslands::mark_shared(std::span<Edge> edges) {
    constexpr size_t kEmpty = ~size_t(0);
    const size_t size = std::bit_ceil(2 * edges.size() + 1);
    std::vector<size_t> table(size, kEmpty);
    for (size_t k = 0; k < edges.size(); ++k) {
        size_t at = mix_bits(edges[k].low ^ mix_bits(edges[k].high)) & (size - 1);
        while (table[at] != kEmpty && !edges[table[at]].joins_same(edges[k])) at = (at + 1) & (size - 1);
        if (table[at] == kEmpty)
            table[at] = k;
        else
            edges[table[at]].is_shared = edges[k].is_shared = true;
    }
}

std::array<int64_t, 2> UvIslands::find_range(double low, double high, uint32_t size) const {
    const auto first = int64_t(std::floor(low - 0.5)), last = int64_t(std::floor(high));
    if (repeats()) return {first, last};
    return {std::max(first, int64_t(-1)), std::min(last, int64_t(size))};
}

std::pair<Point, Point> UvIslands::find_ends(std::span<const Point> face) {
    Point low = face[0], high = face[0];
    for (const Point& p : face) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    return {low, high};
}

/// Inside or on the edge of a polygon (crossings of a ray along x; Shimrat 1962).
bool UvIslands::is_covered(std::span<const Point> face, const Point& p) {
    bool is_inside = false;
    for (size_t k = 0, last = face.size() - 1; k < face.size(); last = k++) {
        const Point &a = face[last], &b = face[k];
        if (is_near_edge(a, b, p)) return true;
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y))
            is_inside = !is_inside;
    }
    return is_inside;
}

} // namespace relief
