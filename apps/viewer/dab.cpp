#include "viewer/dab.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <queue>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "common/vectors.h"
#include "viewer/seen_texels.h"

namespace relief::viewer {

using namespace vectors;

namespace {

/// Nodes of the lattice between the centre of a dab and its edge, about.
constexpr float kNodesPerRadius = 48;
/// Way along the surface from what is seen, in radii, at which weights end.
constexpr float kHiddenReach = 0.75f;
/// How far the surface of a texel may lie from what a pixel shows, in radii: the map may have changed since
/// the picture was made, and a pixel at a rim may show the mean of two places.
constexpr float kStale = 0.5f;
/// Pixels between seen texels, along the surface, that are no way into what is hidden.
constexpr float kSlack = 3;
constexpr int kBlockSide = 32; ///< texels

/// 1 in the middle, 0 from 1 on, without a kink; of the square of the distance.
float find_weight(float square) { return square < 1 ? (1 - square) * (1 - square) : 0; }

/// A place of the lattice: every few texels of a tile.
struct Node {
    int udim = 1001, x = 0, y = 0;
    friend auto operator<=>(const Node&, const Node&) = default;
};

struct NodeHash {
    size_t operator()(const Node& node) const {
        return size_t((uint64_t(uint32_t(node.udim)) * 0x9e3779b97f4a7c15u) ^
                      (uint64_t(uint32_t(node.x)) << 32 | uint32_t(node.y)) * 0xbf58476d1ce4e5b9u);
    }
};

/// Weights on a lattice of texels, from what is seen into what is hidden.
class Lattice {
  public:
    /// `middle`: the texel that the cursor is on.
    Lattice(const Displacement& map, const TexelPlaces& places, const SeenTexel& middle, float radius)
        : map_(map), places_(places), centre_(middle.position), radius_(radius) {
        choose_step(middle);
        // The picture may be older than the map, which all other places come from.
        const auto place = find_place({middle.udim, int(middle.column) / step_, int(middle.row) / step_});
        if (place && length(*place - centre_) < kStale * radius_) centre_ = *place;
    }

    void add_seen(const SeenTexel& texel) {
        const Node node{texel.udim, int(texel.column) / step_, int(texel.row) / step_};
        const std::optional<Vec3f> place = find_place(node);
        if (place && length(*place - texel.position) < kStale * radius_) reach(node, *place, 0);
    }

    /// Goes on along the surface (Dijkstra 1959).
    void spread(float slack) {
        while (!next_.empty()) {
            const auto [way, node] = next_.top();
            next_.pop();
            const Reached from = reached_.at(node);
            if (way > from.way) continue;
            for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
                if (const std::optional<Node> other = find_neighbour(node, dx, dy))
                    if (const std::optional<Vec3f> place = find_place(*other))
                        reach(*other, *place, way + length(*place - from.place));
        }
        for (auto& [node, reached] : reached_) {
            const Vec3f off = (reached.place - centre_) * (1 / radius_);
            const float hidden = std::max(0.0f, reached.way - slack) / (kHiddenReach * radius_);
            reached.weight = find_weight(dot(off, off)) * find_weight(hidden * hidden);
        }
    }

    /// Calls `add(udim, x, y, weight)` for each texel with a weight.
    template <class Add> void visit_texels(const Add& add) const {
        for (const auto& [node, reached] : reached_) {
            const MapTile& tile = *find_tile(node.udim);
            const int right = std::min((node.x + 1) * step_, int(tile.texture->width)),
                      bottom = std::min((node.y + 1) * step_, int(tile.texture->height));
            for (int y = node.y * step_; y < bottom; ++y)
                for (int x = node.x * step_; x < right; ++x)
                    if (const float weight = blend(node, float(x) / float(step_) - float(node.x),
                                                   float(y) / float(step_) - float(node.y));
                        weight > 0)
                        add(node.udim, x, y, weight);
        }
    }

  private:
    /// So that the radius spans about kNodesPerRadius nodes around a texel.
    void choose_step(const SeenTexel& texel) {
        constexpr int kApart = 4;
        const MapTile& tile = *find_tile(texel.udim);
        const auto place = [&](int dx, int dy) {
            return places_.find(map_, tile,
                                std::clamp(int(texel.column) + dx, 0, int(tile.texture->width) - 1),
                                std::clamp(int(texel.row) + dy, 0, int(tile.texture->height) - 1));
        };
        const auto middle = place(0, 0), right = place(kApart, 0), below = place(0, kApart);
        if (!middle || !right || !below) return;
        const float size = std::min(length(*right - *middle), length(*below - *middle)) / kApart;
        const float nodes = radius_ / std::max(size, radius_ * 1e-4f) / kNodesPerRadius;
        step_ = std::clamp(int(nodes), 1, 64);
    }

    struct Reached {
        Vec3f place{};
        float way = 0, weight = 0;
    };

    const MapTile* find_tile(int udim) const {
        if (!tile_ || tile_->udim != udim) {
            const auto found = std::ranges::find(map_.tiles, udim, &MapTile::udim);
            tile_ = found == map_.tiles.end() ? nullptr : &*found;
        }
        return tile_;
    }

    std::optional<Vec3f> find_place(const Node& node) const {
        const MapTile& tile = *find_tile(node.udim);
        return places_.find(map_, tile, std::min(node.x * step_, int(tile.texture->width) - 1),
                            std::min(node.y * step_, int(tile.texture->height) - 1));
    }

    std::optional<Node> find_neighbour(const Node& node, int dx, int dy) const {
        const MapTile& tile = *find_tile(node.udim);
        const int columns = (int(tile.texture->width) + step_ - 1) / step_,
                  rows = (int(tile.texture->height) + step_ - 1) / step_;
        Node other{node.udim, node.x + dx, node.y + dy};
        const bool is_inside = other.x >= 0 && other.y >= 0 && other.x < columns && other.y < rows;
        if (is_inside) return other;
        if (map_.wrap != WrapMode::repeat || map_.is_udim) return std::nullopt;
        other.x = (other.x + columns) % columns, other.y = (other.y + rows) % rows;
        return other;
    }

    void reach(const Node& node, const Vec3f& place, float way) {
        if (!(length(place - centre_) < radius_)) return;
        if (way > (1 + kHiddenReach) * radius_) return;
        const auto [found, is_new] = reached_.try_emplace(node, Reached{place, way, 0});
        if (!is_new && found->second.way <= way) return;
        found->second.way = way;
        next_.push({way, node});
    }

    /// Between the four nodes around a place; those that were not reached have no weight.
    float blend(const Node& node, float s, float t) const {
        const auto weight = [&](int dx, int dy) {
            const auto found = reached_.find({node.udim, node.x + dx, node.y + dy});
            return found == reached_.end() ? 0.0f : found->second.weight;
        };
        if (step_ == 1) return weight(0, 0);
        return (weight(0, 0) * (1 - s) + weight(1, 0) * s) * (1 - t) +
               (weight(0, 1) * (1 - s) + weight(1, 1) * s) * t;
    }

    const Displacement& map_;
    const TexelPlaces& places_;
    Vec3f centre_;
    float radius_;
    int step_ = 1;
    mutable const MapTile* tile_ = nullptr; ///< that was asked for last
    std::unordered_map<Node, Reached, NodeHash> reached_;
    std::priority_queue<std::pair<float, Node>, std::vector<std::pair<float, Node>>, std::greater<>> next_;
};

/// Texels by blocks.
class PieceMaker {
  public:
    void add(int udim, int x, int y, float weight) {
        const Key key{udim, y / kBlockSide, x / kBlockSide};
        if (!last_ || key != last_key_) last_ = &blocks_[key], last_key_ = key;
        (*last_)[size_t(y % kBlockSide) * kBlockSide + size_t(x % kBlockSide)] = weight;
    }

    std::vector<DabPiece> finish() const {
        std::vector<DabPiece> pieces;
        for (const auto& [key, block] : blocks_) pieces.push_back(make_piece(key, block));
        return pieces;
    }

  private:
    using Key = std::tuple<int, int, int>; ///< udim, row and column of the block
    using Block = std::array<float, kBlockSide * kBlockSide>;

    static DabPiece make_piece(const Key& key, const Block& block) {
        TexelBox box{kBlockSide, kBlockSide, 0, 0};
        for (int y = 0; y < kBlockSide; ++y)
            for (int x = 0; x < kBlockSide; ++x)
                if (block[size_t(y * kBlockSide + x)] > 0)
                    box = {std::min(box.x0, x), std::min(box.y0, y), std::max(box.x1, x + 1),
                           std::max(box.y1, y + 1)};
        const auto [udim, row, column] = key;
        DabPiece piece{udim, box, {}};
        for (int y = box.y0; y < box.y1; ++y)
            for (int x = box.x0; x < box.x1; ++x) piece.weights.push_back(block[size_t(y * kBlockSide + x)]);
        const int left = column * kBlockSide, top = row * kBlockSide;
        piece.box = {box.x0 + left, box.y0 + top, box.x1 + left, box.y1 + top};
        return piece;
    }

    std::map<Key, Block> blocks_;
    Block* last_ = nullptr;
    Key last_key_;
};

} // namespace

std::vector<DabPiece> find_dab(const Scene& scene, const ShownPicture& picture, const SurfacePoint& centre,
                               float radius, const TexelPlaces& places) {
    const Displacement& map = scene.displacements[scene.objects[centre.object].displacement];
    const float radius_world = radius * centre.pixel_size;
    if (!(radius_world > 0)) return {};
    const std::vector<SeenTexel> seen = find_seen_texels(scene, picture, centre, radius_world);
    if (seen.empty()) return {};
    const auto middle = std::ranges::min_element(
        seen, {}, [&](const SeenTexel& texel) { return length(texel.position - centre.position); });
    Lattice lattice(map, places, *middle, radius_world);
    for (const SeenTexel& texel : seen) lattice.add_seen(texel);
    lattice.spread(kSlack * find_pixel_width(picture, centre));
    PieceMaker pieces;
    lattice.visit_texels([&](int udim, int x, int y, float weight) { pieces.add(udim, x, y, weight); });
    return pieces.finish();
}

} // namespace relief::viewer
