#include "surface/map/bounds_pyramid.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "base/parallel.h"
#include "image/texel_layout.h"
#include "relief/error.h"
#include "surface/map/texels.h"
#include "surface/map/wrapped_range.h"

namespace relief {

namespace {

constexpr uint32_t kBlock = 8;
constexpr int64_t kLargestSpan = 8; // nodes of the level that a query reads, per axis

ChannelRange make_empty_range() {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    return {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
}

void extend(ChannelRange& range, const std::array<float, 3>& low, const std::array<float, 3>& high) {
    for (int c = 0; c < 3; ++c) {
        range.low[c] = std::min(range.low[c], low[c]);
        range.high[c] = std::max(range.high[c], high[c]);
    }
}

void check_size(const Texture& texture) {
    if (!is_complete(texture))
        throw Error(ErrorKind::bad_input, {fmt::format("map is {} x {} texels and holds {} bytes",
                                                       texture.width, texture.height, texture.byte_count()),
                                           texture.file, "write the image again"});
}

ChannelRange compute_block(const Texture& texture, uint32_t block_x, uint32_t block_y) {
    const TexelRectangle block{block_x * kBlock, block_y * kBlock,
                               std::min((block_x + 1) * kBlock, texture.width) - 1,
                               std::min((block_y + 1) * kBlock, texture.height) - 1};
    const std::optional<ChannelRange> range = find_texel_range(texture, block);
    if (!range) refuse_bad_texel(texture, block);
    return *range;
}

} // namespace

BoundsPyramid BoundsPyramid::build(const Texture& texture) {
    check_size(texture);
    BoundsPyramid pyramid;
    pyramid.width_ = texture.width;
    pyramid.height_ = texture.height;
    Level base;
    base.width = (texture.width + kBlock - 1) / kBlock;
    base.height = (texture.height + kBlock - 1) / kBlock;
    base.ranges.resize(size_t(base.width) * base.height);
    parallel_for("bounds pyramid", base.height, 4, [&](size_t begin, size_t end) {
        for (size_t y = begin; y < end; ++y)
            for (uint32_t x = 0; x < base.width; ++x)
                base.ranges[y * base.width + x] = compute_block(texture, x, uint32_t(y));
    });
    pyramid.levels_.push_back(std::move(base));
    while (pyramid.levels_.back().width > 1 || pyramid.levels_.back().height > 1) {
        const Level& fine = pyramid.levels_.back();
        Level coarse;
        coarse.width = (fine.width + 1) / 2;
        coarse.height = (fine.height + 1) / 2;
        coarse.ranges.resize(size_t(coarse.width) * coarse.height);
        join_ranges(fine, coarse, {0, 0, coarse.width - 1, coarse.height - 1});
        pyramid.levels_.push_back(std::move(coarse));
    }
    return pyramid;
}

void BoundsPyramid::join_ranges(const Level& fine, Level& coarse, const TexelRectangle& nodes) {
    for (uint32_t y = nodes.y0; y <= nodes.y1; ++y)
        for (uint32_t x = nodes.x0; x <= nodes.x1; ++x) {
            ChannelRange& joined = coarse.ranges[size_t(y) * coarse.width + x];
            joined = make_empty_range();
            for (uint32_t row = 2 * y; row < std::min(2 * y + 2, fine.height); ++row)
                for (uint32_t column = 2 * x; column < std::min(2 * x + 2, fine.width); ++column) {
                    const ChannelRange& range = fine.ranges[size_t(row) * fine.width + column];
                    extend(joined, range.low, range.high);
                }
        }
}

void BoundsPyramid::update(const Texture& texture, const TexelRectangle& changed) {
    TexelRectangle nodes{changed.x0 / kBlock, changed.y0 / kBlock, changed.x1 / kBlock, changed.y1 / kBlock};
    parallel_for("bounds of an edit", nodes.y1 - nodes.y0 + 1, 4, [&](size_t begin, size_t end) {
        for (size_t row = nodes.y0 + begin; row < nodes.y0 + end; ++row)
            for (uint32_t x = nodes.x0; x <= nodes.x1; ++x)
                levels_[0].ranges[row * levels_[0].width + x] = compute_block(texture, x, uint32_t(row));
    });
    for (size_t level = 1; level < levels_.size(); ++level) {
        nodes = {nodes.x0 / 2, nodes.y0 / 2, nodes.x1 / 2, nodes.y1 / 2};
        join_ranges(levels_[level - 1], levels_[level], nodes);
    }
}

ChannelRange BoundsPyramid::query(int64_t x0, int64_t y0, int64_t x1, int64_t y1, WrapMode wrap,
                                  const std::array<float, 3>& black) const {
    const WrappedRange columns = wrap_range(x0, x1, width_, wrap), rows = wrap_range(y0, y1, height_, wrap);
    ChannelRange range = make_empty_range();
    if (columns.is_outside_read || rows.is_outside_read) extend(range, black, black);
    for (int r = 0; r < rows.count; ++r)
        for (int c = 0; c < columns.count; ++c) {
            auto [left, right] = columns.parts[c];
            auto [top, bottom] = rows.parts[r];
            left /= kBlock, right /= kBlock, top /= kBlock, bottom /= kBlock;
            size_t level = 0;
            while (right - left >= kLargestSpan || bottom - top >= kLargestSpan) {
                left /= 2, right /= 2, top /= 2, bottom /= 2;
                ++level;
            }
            const Level& nodes = levels_[level];
            for (int64_t y = top; y <= bottom; ++y)
                for (int64_t x = left; x <= right; ++x) {
                    const ChannelRange& node = nodes.ranges[size_t(y) * nodes.width + size_t(x)];
                    extend(range, node.low, node.high);
                }
        }
    return range;
}

size_t BoundsPyramid::byte_count() const {
    size_t bytes = 0;
    for (const Level& level : levels_) bytes += level.ranges.size() * sizeof(ChannelRange);
    return bytes;
}

} // namespace relief
