#include "viewer/dab.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>

#include "common/vectors.h"
#include "viewer/picture_layers.h"

namespace relief::viewer {

using namespace vectors;

namespace {

/// Pixels to those that derivatives are taken from: samples lie anywhere within their pixels. Of small
/// pictures the second, as far as the first lies beyond a seam.
constexpr int kReaches[] = {3, 1};
/// Two pixels of which uv differs by more lie on two sides of a seam.
constexpr float kSeam = 0.25f;
/// Pixels that are further apart in space than this many widths of a pixel on their surface lie on two
/// sheets.
constexpr float kJump = 1.5f;
constexpr float kLeastCosine = 0.3f; ///< of surfaces that are seen at a flat angle
/// Texels per length that differ by more from those of most pixels: uvs of two places were mixed.
constexpr float kMostStretch = 4;
/// Pixels around a sample whose texels it speaks for.
constexpr float kFootprint = 2;
constexpr float kMostTexels = 128; ///< of a footprint, per side
constexpr int kBlockSide = 32;     ///< texels

/// 1 in the middle, 0 from 1 on, without a kink; of the square of the distance.
float find_weight(float square) { return square < 1 ? (1 - square) * (1 - square) : 0; }

/// Change along one axis of the picture.
struct Change {
    Vec2f uv;
    Vec3f position;
};

/// What one pixel says of the surface. Changes are per pixel of the shown picture.
struct Sample {
    Vec2f uv;
    Vec3f position;
    Change right, down;
    int udim = 1001;
    float stretch = 0; ///< change of uv per length
};

class SampleReader {
  public:
    SampleReader(const Scene& scene, const ShownPicture& picture, const SurfacePoint& centre)
        : scene_(scene), picture_(picture), layers_(picture.image), centre_(centre) {
        pixel_ = centre.pixel_size * float(picture.full_width) / float(picture.image.width);
        is_udim_ = scene.displacements[scene.objects[centre.object].displacement].is_udim;
    }

    /// Those of pixels within `radius`, world units, and a little more.
    std::vector<Sample> read(float radius) {
        std::vector<Sample> samples;
        const Vec3f forward = normalize(picture_.camera.to - picture_.camera.from);
        const float nearer = std::min(0.75f, radius / std::max(centre_.distance, 1e-20f));
        const float reach = radius / (pixel_ * (1 - nearer)) + kFootprint + 1;
        const auto [x, y] = find_pixel(forward);
        const int x0 = std::max(0, int(x - reach)), x1 = std::min(picture_.image.width, int(x + reach) + 1);
        const int y0 = std::max(0, int(y - reach)), y1 = std::min(picture_.image.height, int(y + reach) + 1);
        const float most = radius + (kFootprint + 1) * pixel_;
        for (int row = y0; row < y1; ++row)
            for (int column = x0; column < x1; ++column)
                if (is_object(column, row) && length(layers_.position(column, row) - centre_.position) < most)
                    if (const std::optional<Sample> sample = read_sample(column, row))
                        samples.push_back(*sample);
        drop_mixtures(samples);
        return samples;
    }

  private:
    /// Where the picture shows the centre.
    Vec2f find_pixel(const Vec3f& forward) const {
        const Vec3f right = normalize(cross(forward, picture_.camera.up)), up = cross(right, forward);
        const Vec3f to = centre_.position - picture_.camera.from;
        const float wide = float(picture_.image.width), high = float(picture_.image.height);
        return {0.5f * wide - picture_.camera.shift.x * high + dot(to, right) / pixel_,
                0.5f * high + picture_.camera.shift.y * high - dot(to, up) / pixel_};
    }

    bool is_object(int x, int y) const {
        return layers_.has_surface(x, y) && layers_.id(x, y) == float(centre_.object + 1);
    }

    /// Between pixels at most `pixels` apart on one sheet.
    std::optional<Change> find_change(int x, int y, int to_x, int to_y, float longest) const {
        if (!is_object(to_x, to_y)) return std::nullopt;
        const Vec2f a = layers_.uv(x, y), b = layers_.uv(to_x, to_y);
        const Change change{{b.x - a.x, b.y - a.y}, layers_.position(to_x, to_y) - layers_.position(x, y)};
        if (std::fabs(change.uv.x) > kSeam || std::fabs(change.uv.y) > kSeam ||
            length(change.position) > longest)
            return std::nullopt;
        return change;
    }

    /// By the neighbours before and behind, as far as they lie on the same sheet.
    std::optional<Change> differentiate(int x, int y, int right, int down, float width) const {
        for (const int reach : kReaches) {
            const float longest = kJump * float(reach + 1) * width;
            const auto next = find_change(x, y, x + reach * right, y + reach * down, longest);
            const auto last = find_change(x, y, x - reach * right, y - reach * down, longest);
            if (!next && !last) continue;
            const float pixels = float(reach) * float(int(next.has_value()) + int(last.has_value()));
            const Change a = next.value_or(Change{}), b = last.value_or(Change{});
            return Change{{(a.uv.x - b.uv.x) / pixels, (a.uv.y - b.uv.y) / pixels},
                          (a.position - b.position) * (1 / pixels)};
        }
        return std::nullopt;
    }

    std::optional<Sample> read_sample(int x, int y) {
        const Vec3f position = layers_.position(x, y);
        const Vec3f view = normalize(position - picture_.camera.from);
        const float cosine = std::max(std::fabs(dot(normalize(layers_.normal(x, y)), view)), kLeastCosine);
        const auto right = differentiate(x, y, 1, 0, pixel_ / cosine),
                   down = differentiate(x, y, 0, 1, pixel_ / cosine);
        if (!right || !down) return std::nullopt;
        Sample sample{layers_.uv(x, y), position, *right, *down};
        const float way = length(right->position) + length(down->position);
        sample.stretch = (std::hypot(right->uv.x, right->uv.y) + std::hypot(down->uv.x, down->uv.y)) /
                         std::max(way, 1e-30f);
        if (is_udim_) sample.udim = find_tile(x, y, sample);
        return sample;
    }

    /// The tile of the last pixel where uvs go on from there; else it is looked for among all faces.
    int find_tile(int x, int y, const Sample& sample) {
        const bool goes_on = y == last_y_ && x == last_x_ + 1 &&
                             std::hypot(sample.uv.x - last_uv_.x, sample.uv.y - last_uv_.y) <
                                 4 * (std::hypot(sample.right.uv.x, sample.right.uv.y) + 1e-6f);
        if (!goes_on) {
            SurfacePoint point = centre_;
            point.uv = sample.uv, point.position = sample.position;
            last_udim_ = find_udim(scene_, point);
        }
        last_x_ = x, last_y_ = y, last_uv_ = sample.uv;
        return last_udim_;
    }

    /// A pixel on a seam may hold the mean of two places of the map.
    static void drop_mixtures(std::vector<Sample>& samples) {
        if (samples.empty()) return;
        std::vector<float> stretches;
        for (const Sample& sample : samples) stretches.push_back(sample.stretch);
        const auto middle = stretches.begin() + std::ptrdiff_t(stretches.size() / 2);
        std::nth_element(stretches.begin(), middle, stretches.end());
        const float most = kMostStretch * *middle;
        std::erase_if(samples, [&](const Sample& sample) { return sample.stretch > most; });
    }

    const Scene& scene_;
    const ShownPicture& picture_;
    const PictureLayers layers_;
    const SurfacePoint& centre_;
    float pixel_ = 0; ///< width of a pixel of the shown picture at the centre
    bool is_udim_ = false;
    int last_x_ = -2, last_y_ = -1, last_udim_ = 1001;
    Vec2f last_uv_{};
};

/// Means of the weights that samples give to texels.
class WeightSums {
  public:
    WeightSums(const Displacement& map, const SurfacePoint& centre, float radius)
        : map_(map), centre_(centre), radius_(radius) {}

    void add(const Sample& sample) {
        const auto tile = std::ranges::find(map_.tiles, sample.udim, &MapTile::udim);
        if (tile == map_.tiles.end() || !tile->texture) return;
        const int width = int(tile->texture->width), height = int(tile->texture->height);
        const float along_v = map_.flip_v ? 1.0f : -1.0f;
        const auto to_texels = [&](const Vec2f& change) {
            return Vec2f{change.x * float(width), change.y * float(height) * along_v};
        };
        const float row = map_.flip_v ? sample.uv.y : 1 - sample.uv.y;
        const Vec2f at{(sample.uv.x - std::floor(sample.uv.x)) * float(width),
                       (row - std::floor(row)) * float(height)};
        const Vec2f right = to_texels(sample.right.uv), down = to_texels(sample.down.uv);
        const float determinant = right.x * down.y - right.y * down.x;
        if (!(std::fabs(determinant) > 1e-12f)) return;
        const float across = std::min(kFootprint * (std::fabs(right.x) + std::fabs(down.x)), kMostTexels);
        const float below = std::min(kFootprint * (std::fabs(right.y) + std::fabs(down.y)), kMostTexels);
        for (int y = int(std::floor(at.y - below)); float(y) <= at.y + below; ++y)
            for (int x = int(std::floor(at.x - across)); float(x) <= at.x + across; ++x) {
                const float dx = float(x) + 0.5f - at.x, dy = float(y) + 0.5f - at.y;
                const float a = (dx * down.y - dy * down.x) / determinant,
                            b = (dy * right.x - dx * right.y) / determinant;
                const float share = std::max(0.0f, 1 - std::fabs(a) / kFootprint) *
                                    std::max(0.0f, 1 - std::fabs(b) / kFootprint);
                if (share > 0)
                    add_texel(sample.udim, wrap(x, width), wrap(y, height), share,
                              sample.position + sample.right.position * a + sample.down.position * b);
            }
    }

    std::vector<DabPiece> finish() const {
        std::vector<DabPiece> pieces;
        for (const auto& [key, block] : blocks_)
            if (std::optional<DabPiece> piece = make_piece(key, block)) pieces.push_back(std::move(*piece));
        return pieces;
    }

  private:
    using Key = std::tuple<int, int, int>; ///< udim, row and column of the block
    struct Block {
        std::array<float, kBlockSide * kBlockSide> weights{}, shares{};
    };

    /// Negative: beyond the tile.
    int wrap(int place, int size) const {
        if (place >= 0 && place < size) return place;
        if (map_.wrap != WrapMode::repeat || map_.is_udim) return -1;
        return (place % size + size) % size;
    }

    void add_texel(int udim, int x, int y, float share, const Vec3f& position) {
        if (x < 0 || y < 0) return;
        const Key key{udim, y / kBlockSide, x / kBlockSide};
        if (!last_ || key != last_key_) last_ = &blocks_[key], last_key_ = key;
        const size_t place = size_t(y % kBlockSide) * kBlockSide + size_t(x % kBlockSide);
        const Vec3f off = (position - centre_.position) * (1 / radius_);
        last_->weights[place] += share * find_weight(dot(off, off));
        last_->shares[place] += share;
    }

    static std::optional<DabPiece> make_piece(const Key& key, const Block& block) {
        const auto [udim, row, column] = key;
        TexelBox box{kBlockSide, kBlockSide, 0, 0};
        for (int y = 0; y < kBlockSide; ++y)
            for (int x = 0; x < kBlockSide; ++x)
                if (block.weights[size_t(y * kBlockSide + x)] > 0)
                    box = {std::min(box.x0, x), std::min(box.y0, y), std::max(box.x1, x + 1),
                           std::max(box.y1, y + 1)};
        if (box.is_empty()) return std::nullopt;
        DabPiece piece{udim, box, {}};
        for (int y = box.y0; y < box.y1; ++y)
            for (int x = box.x0; x < box.x1; ++x) {
                const size_t place = size_t(y * kBlockSide + x);
                piece.weights.push_back(block.weights[place] > 0 ? block.weights[place] / block.shares[place]
                                                                 : 0);
            }
        const int left = column * kBlockSide, top = row * kBlockSide;
        piece.box = {box.x0 + left, box.y0 + top, box.x1 + left, box.y1 + top};
        return piece;
    }

    const Displacement& map_;
    const SurfacePoint& centre_;
    float radius_;
    std::map<Key, Block> blocks_;
    Block* last_ = nullptr;
    Key last_key_;
};

} // namespace

std::vector<DabPiece> find_dab(const Scene& scene, const ShownPicture& picture, const SurfacePoint& centre,
                               float radius) {
    const Displacement& map = scene.displacements[scene.objects[centre.object].displacement];
    const float radius_world = radius * centre.pixel_size;
    if (!(radius_world > 0)) return {};
    WeightSums sums(map, centre, radius_world);
    for (Sample sample : SampleReader(scene, picture, centre).read(radius_world)) {
        if (!map.is_udim) sample.udim = map.tiles.front().udim;
        sums.add(sample);
    }
    return sums.finish();
}

} // namespace relief::viewer
