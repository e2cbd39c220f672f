#include "surface/patch/patch_mips.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "formulas/mips.h"
#include "math/vec_double.h"
#include "surface/map/mip_chain.h"

namespace relief {

namespace {

constexpr int kFinestDetail = 20; // levels; a cell is far below a float's steps there

class MipChooser {
  public:
    MipChooser(const Surface& surface, std::span<const LevelField* const> levels)
        : surface_(surface), levels_(levels), corners_(surface.vertex_count(), scalar::kMaxMip) {}

    std::vector<uint32_t> run() {
        std::vector<uint32_t> mips(surface_.patch_count());
        for (uint32_t patch = 0; patch < surface_.patch_count(); ++patch) {
            mips[patch] = choose_detail(patch);
            if (!surface_.map.is_filtered || levels_.empty()) continue;
            mips[patch] |= scalar::pack_mip(choose_inside(patch), scalar::kMipInside);
            for (int edge = 0; edge < 4; ++edge)
                mips[patch] |= scalar::pack_mip(choose_edge(patch, edge), scalar::kMipEdges + uint32_t(edge));
        }
        if (!surface_.map.is_filtered || levels_.empty()) return mips;
        for (uint32_t patch = 0; patch < surface_.patch_count(); ++patch)
            for (uint32_t k = 0; k < 4; ++k)
                mips[patch] |= scalar::pack_mip(corners_[surface_.dominant(surface_.quads[patch].vertex[k])],
                                                scalar::kMipCorners + k);
        return mips;
    }

  private:
    bool has_map(TileIndex tile) const { return tile < surface_.map.tiles.size(); }

    double count_texels(TileIndex tile, const Vec2f& a, const Vec2f& b) const {
        const Texture& texture = *surface_.map.tiles[tile].texture;
        return compute_length((double(b.x) - a.x) * texture.width, (double(b.y) - a.y) * texture.height);
    }

    /// Smallest copy whose texels are not larger than a cell of a line at `level`.
    uint32_t choose(TileIndex tile, double texels, int level) const {
        const auto& chain = surface_.map.tiles[tile].mips;
        const int most = chain ? int(std::min(chain->count(), scalar::kMaxMip)) : 0;
        return uint32_t(std::clamp(int(std::floor(std::log2(std::max(texels, 1.0)))) - level, 0, most));
    }

    /// Texels across the middle of a patch, along u and along v.
    std::array<double, 2> measure_middle(uint32_t patch, TileIndex tile) const {
        std::array<Vec2f, 4> uv;
        for (size_t k = 0; k < 4; ++k) uv[k] = surface_.uvs[surface_.quads[patch].vertex[k]];
        const auto middle = [&](size_t a, size_t b) {
            return Vec2f{(uv[a].x + uv[b].x) / 2, (uv[a].y + uv[b].y) / 2};
        };
        return {count_texels(tile, middle(0, 3), middle(1, 2)),
                count_texels(tile, middle(0, 1), middle(3, 2))};
    }

    uint32_t choose_detail(uint32_t patch) const {
        const TileIndex tile = surface_.tile(surface_.quads[patch].vertex[0]);
        if (!surface_.map.has_autobump || !has_map(tile)) return 0;
        const auto [along_u, along_v] = measure_middle(patch, tile);
        const int level = int(std::ceil(std::log2(std::max({along_u, along_v, 1.0}))));
        return uint32_t(std::min(level, kFinestDetail) + 1) << scalar::kDetailShift;
    }

    uint32_t choose_inside(uint32_t patch) const {
        const TileIndex tile = surface_.tile(surface_.quads[patch].vertex[0]);
        if (!has_map(tile)) return 0;
        const auto [along_u, along_v] = measure_middle(patch, tile);
        int finest = 0;
        for (const LevelField* field : levels_) finest = std::max(finest, int(field->at(patch).patch));
        return choose(tile, std::min(along_u, along_v), finest);
    }

    /// Also takes note of it at those ends that are displaced by the same tile.
    uint32_t choose_edge(uint32_t patch, int edge) {
        const Surface::EdgeLine line = surface_.edge_line(patch, edge);
        const TileIndex tile = surface_.tile(line.first);
        if (!has_map(tile)) return 0;
        int finest = 0;
        for (const LevelField* field : levels_)
            finest = std::max(finest, int(field->at(patch).edge[size_t(edge)]));
        const uint32_t mip =
            choose(tile, count_texels(tile, surface_.uvs[line.first], surface_.uvs[line.second]), finest);
        for (const uint32_t vertex : {line.first, line.second}) {
            const uint32_t dominant = surface_.dominant(vertex);
            if (surface_.tile(dominant) == tile)
                corners_[dominant] = std::min(corners_[dominant], uint8_t(mip));
        }
        return mip;
    }

    const Surface& surface_;
    std::span<const LevelField* const> levels_;
    std::vector<uint8_t> corners_; ///< by dominant vertex
};

} // namespace

std::vector<uint32_t> choose_mips(const Surface& surface, std::span<const LevelField* const> levels) {
    if (!surface.has_displacement || !(surface.map.is_filtered || surface.map.has_autobump)) return {};
    return MipChooser(surface, levels).run();
}

} // namespace relief
