#include "surface/map/mip_chain.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "formulas/mips.h"
#include "image/texel_layout.h"
#include "surface/map/texels.h"

namespace relief {

namespace {

constexpr uint32_t kFilledTexels = 2; ///< texels beside an island that are filled

/// What a texel of a copy is the mean of, along one axis: up to three texels and their shares.
struct Taps {
    uint32_t first = 0, count = 0;
    std::array<double, 3> weight{};
};

Taps make_taps(uint32_t index, uint32_t coarse_size, uint32_t fine_size) {
    const double low = double(uint64_t(index) * fine_size) / coarse_size;
    const double high = double(uint64_t(index + 1) * fine_size) / coarse_size;
    Taps taps;
    taps.first = uint32_t(low);
    for (uint32_t k = taps.first; double(k) < high && k < fine_size && taps.count < 3; ++k)
        taps.weight[taps.count++] = std::min(high, double(k) + 1) - std::max(low, double(k));
    return taps;
}

/// Texels of a copy that read [first, last] of the larger one.
std::pair<uint32_t, uint32_t> find_readers(uint32_t first, uint32_t last, uint32_t coarse_size,
                                           uint32_t fine_size) {
    const auto begin = uint32_t(uint64_t(first) * coarse_size / fine_size);
    const auto end = uint32_t((uint64_t(last + 1) * coarse_size + fine_size - 1) / fine_size);
    return {begin, std::min(end, coarse_size) - 1};
}

void write_texel(Texture& texture, uint32_t x, uint32_t y, const std::array<double, 4>& value) {
    const size_t place = texture.find_texel(x, y);
    for (size_t c = 0; c < texture.stride; ++c) store_value(texture, place + c, float(value[c]));
}

std::shared_ptr<Texture> make_smaller(const Texture& texture) {
    auto result = std::make_shared<Texture>();
    result->width = (texture.width + 1) / 2, result->height = (texture.height + 1) / 2;
    result->file = texture.file;
    make_values_like(texture, *result);
    return result;
}

/// Texels whose centres lie in no face.
TexelMask find_uncovered(const Texture& texture, WrapMode wrap, const UvIslands& islands) {
    TexelMask uncovered(texture, true);
    const auto find = [&](int64_t x, int64_t y) {
        return std::pair{wrap_index(x, texture.width, wrap), wrap_index(y, texture.height, wrap)};
    };
    const auto is_open = [&](int64_t x, int64_t y) {
        const auto [column, row] = find(x, y);
        return column >= 0 && row >= 0 && uncovered.has(column, row);
    };
    islands.visit_covered(is_open, [&](int64_t x, int64_t y) {
        const auto [column, row] = find(x, y);
        uncovered.set(column, row, false);
    });
    return uncovered;
}

/// The value that more than half of the texels in a mask hold, if there is one (Boyer and Moore 1981).
std::optional<TexelBits> find_majority(const Texture& texture, const TexelMask& mask) {
    const auto visit = [&](const auto& look) {
        for (uint32_t y = 0; y < texture.height; ++y)
            for (uint32_t x = 0; x < texture.width; ++x)
                if (mask.has(x, y)) look(get_texel_bits(texture, x, y));
    };
    TexelBits candidate{};
    uint64_t lead = 0, count = 0, held = 0;
    visit([&](const TexelBits& bits) {
        if (lead == 0) candidate = bits;
        lead += bits == candidate ? 1 : uint64_t(-1);
    });
    visit([&](const TexelBits& bits) { ++count, held += bits == candidate; });
    if (2 * held <= count) return std::nullopt;
    return candidate;
}

TexelRectangle cover_all(const Texture& texture) { return {0, 0, texture.width - 1, texture.height - 1}; }

} // namespace

OutsideTexels find_outside_texels(const Displacement& displacement, const MapTile& tile,
                                  std::span<const UvOutlines* const> meshes) {
    const Texture& texture = *tile.texture;
    if (!may_have_background(texture)) return {};
    UvIslands islands(displacement, tile);
    for (const UvOutlines* mesh : meshes) islands.add(*mesh);
    if (islands.is_all_covered()) return {};
    OutsideTexels outside{find_uncovered(texture, displacement.wrap, islands), {}};
    const std::optional<TexelBits> background = find_majority(texture, outside.uncovered);
    if (!background) return {};
    outside.background = *background;
    return outside;
}

MipChain::MipChain(const Texture& texture, OutsideTexels outside, WrapMode wrap)
    : outside_(std::move(outside)), wrap_(wrap) {
    const Texture* larger = &texture;
    do {
        Copy copy;
        copy.texture = make_smaller(*larger);
        if (!outside_.uncovered.is_empty())
            copy.is_outside.resize(size_t(copy.texture->width) * copy.texture->height);
        copies_.push_back(std::move(copy));
        Copy& last = copies_.back();
        remake(texture, copies_.size() - 1, cover_all(*larger));
        last.pyramid = std::make_shared<BoundsPyramid>(BoundsPyramid::build(*last.texture));
        larger = last.texture.get();
    } while (copies_.size() < scalar::kMaxMip && larger->width * larger->height > 1);
}

/// Makes all texels of a copy anew that depend on a rectangle of the one before; returns which.
TexelRectangle MipChain::remake(const Texture& texture, size_t index, const TexelRectangle& changed) {
    const Texture& fine = index == 0 ? texture : *copies_[index - 1].texture;
    Copy& copy = copies_[index];
    const Texture& coarse = *copy.texture;
    const std::pair columns = find_readers(changed.x0, changed.x1, coarse.width, fine.width);
    const std::pair rows = find_readers(changed.y0, changed.y1, coarse.height, fine.height);
    TexelRectangle where{columns.first, rows.first, columns.second, rows.second};
    if (!copy.is_outside.empty()) {
        // Texels beside islands depend on their neighbours; at the border also on those around it.
        const bool is_inner = where.x0 >= kFilledTexels && where.y0 >= kFilledTexels &&
                              where.x1 + kFilledTexels < coarse.width &&
                              where.y1 + kFilledTexels < coarse.height;
        where = is_inner ? TexelRectangle{where.x0 - kFilledTexels, where.y0 - kFilledTexels,
                                          where.x1 + kFilledTexels, where.y1 + kFilledTexels}
                         : cover_all(coarse);
    }
    average(texture, index, where);
    fill_borders(copy, where);
    return where;
}

void MipChain::average(const Texture& texture, size_t index, const TexelRectangle& where) {
    const Texture& fine = index == 0 ? texture : *copies_[index - 1].texture;
    Copy& copy = copies_[index];
    Texture& coarse = *copy.texture;
    const auto is_outside = [&](uint32_t x, uint32_t y) {
        if (index == 0) return outside_.holds(texture, x, y);
        const std::vector<uint8_t>& flags = copies_[index - 1].is_outside;
        return !flags.empty() && flags[size_t(y) * fine.width + x] != 0;
    };
    const auto average_one = [&](uint32_t x, uint32_t y) {
        const Taps columns = make_taps(x, coarse.width, fine.width),
                   rows = make_taps(y, coarse.height, fine.height);
        std::array<double, 4> inside{}, all{};
        double inside_weight = 0, weight = 0;
        for (uint32_t j = 0; j < rows.count; ++j)
            for (uint32_t i = 0; i < columns.count; ++i) {
                const std::array<float, 4> texel = read_channels(fine, columns.first + i, rows.first + j);
                const double share = columns.weight[i] * rows.weight[j];
                const double own = is_outside(columns.first + i, rows.first + j) ? 0 : share;
                weight += share, inside_weight += own;
                for (size_t c = 0; c < 4; ++c) all[c] += share * texel[c], inside[c] += own * texel[c];
            }
        const bool is_any = inside_weight > 0;
        for (size_t c = 0; c < 4; ++c) all[c] = is_any ? inside[c] / inside_weight : all[c] / weight;
        write_texel(coarse, x, y, all);
        if (!copy.is_outside.empty()) copy.is_outside[size_t(y) * coarse.width + x] = !is_any;
    };
    parallel_for("smaller copy of a map", where.y1 - where.y0 + 1, 16, [&](size_t begin, size_t end) {
        for (size_t row = begin; row < end; ++row)
            for (uint32_t x = where.x0; x <= where.x1; ++x) average_one(x, where.y0 + uint32_t(row));
    });
}

/// Gives the texels beside islands the value of the nearest inside.
void MipChain::fill_borders(Copy& copy, const TexelRectangle& where) const {
    if (copy.is_outside.empty()) return;
    Texture& texture = *copy.texture;
    constexpr int64_t reach = kFilledTexels;
    const int64_t width = texture.width, height = texture.height;
    const auto fill_one = [&](int64_t x, int64_t y) {
        int64_t best = 2 * reach * reach + 1, from = -1;
        for (int64_t dy = -reach; dy <= reach; ++dy)
            for (int64_t dx = -reach; dx <= reach; ++dx) {
                const int64_t column = wrap_index(x + dx, width, wrap_),
                              row = wrap_index(y + dy, height, wrap_);
                if (column < 0 || row < 0 || dx * dx + dy * dy >= best) continue;
                if (copy.is_outside[size_t(row * width + column)]) continue;
                best = dx * dx + dy * dy, from = row * width + column;
            }
        if (from < 0) return;
        const std::array<float, 4> value = read_channels(texture, from % width, from / width);
        write_texel(texture, uint32_t(x), uint32_t(y), {value[0], value[1], value[2], value[3]});
    };
    parallel_for("borders of a map's islands", where.y1 - where.y0 + 1, 16, [&](size_t begin, size_t end) {
        for (size_t row = where.y0 + begin; row < where.y0 + end; ++row)
            for (uint32_t x = where.x0; x <= where.x1; ++x)
                if (copy.is_outside[row * texture.width + x]) fill_one(x, int64_t(row));
    });
}

std::vector<TexelRectangle> MipChain::update(const Texture& texture, const TexelRectangle& changed) {
    std::vector<TexelRectangle> rectangles;
    TexelRectangle last = changed;
    for (size_t k = 0; k < copies_.size(); ++k) {
        last = remake(texture, k, last);
        copies_[k].pyramid->update(*copies_[k].texture, last);
        rectangles.push_back(last);
    }
    return rectangles;
}

size_t MipChain::byte_count() const {
    size_t bytes = outside_.uncovered.byte_count();
    for (const Copy& copy : copies_)
        bytes += copy.texture->byte_count() + copy.pyramid->byte_count() + copy.is_outside.size();
    return bytes;
}

} // namespace relief
