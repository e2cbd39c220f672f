#include "surface/mesh/uv_islands.h"

#include <algorithm>
#include <bit>

#include "base/stop_request.h"
#include "math/vec_double.h"
#include "surface/map/texels.h"

namespace relief {

namespace {

using Point = UvIslands::Point;

constexpr uint32_t kProbes = 64;         ///< a side: texels looked at before anything is worked out
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
    Ids ids;
    for (size_t face = 0; face < outlines.face_count(); ++face) add_face(outlines.face(face), ids, edges);
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.key < b.key; });
    for (size_t k = 0; k < edges.size(); ++k) {
        const bool is_shared = (k > 0 && edges[k - 1].key == edges[k].key) ||
                               (k + 1 < edges.size() && edges[k + 1].key == edges[k].key);
        if (!is_shared) borders_.push_back(edges[k].ends);
    }
}

void UvIslands::add_face(std::span<const Vec2f> uvs, Ids& ids, std::vector<Edge>& edges) {
    if (starts_.size() % kFacesALook == 0) stop_if_asked();
    const size_t size = uvs.size();
    Point middle{};
    for (const Vec2f& uv : uvs)
        middle = {middle.x + double(uv.x) / double(size), middle.y + double(uv.y) / double(size)};
    Point offset{};
    if (displacement_.is_udim) {
        offset = {std::floor(middle.x), std::floor(middle.y)};
        if (!(offset.x >= 0 && offset.x <= 9 && 1001 + offset.x + 10 * offset.y == udim_)) return;
    }
    std::vector<uint64_t> face_ids;
    std::vector<Point> corners;
    for (const Vec2f& uv : uvs) {
        const uint64_t bits =
            uint64_t(std::bit_cast<uint32_t>(uv.x + 0.0f)) << 32 | std::bit_cast<uint32_t>(uv.y + 0.0f);
        face_ids.push_back(ids.try_emplace(bits, ids.size()).first->second);
        const double v = double(uv.y) - offset.y;
        corners.push_back({(double(uv.x) - offset.x) * texture_.width,
                           (displacement_.flip_v ? v : 1 - v) * texture_.height});
    }
    const auto [low, high] = find_ends(corners);
    const double width = high.x - low.x, height = high.y - low.y;
    const bool is_far = !(std::fabs(low.x) + std::fabs(high.x) < kFarthest &&
                          std::fabs(low.y) + std::fabs(high.y) < kFarthest);
    if (repeats() && (is_far || width > 2.0 * texture_.width || height > 2.0 * texture_.height))
        is_all_covered_ = true;
    if (is_far) return;
    corners_.insert(corners_.end(), corners.begin(), corners.end());
    starts_.push_back(corners_.size());
    for (size_t k = 0; k < size; ++k) {
        const size_t next = (k + 1) % size;
        edges.push_back({std::minmax(face_ids[k], face_ids[next]), {corners[k], corners[next]}});
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
