#include "surface/bounds_pyramid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/parallel.h"
#include "relief/error.h"
#include "surface/texels.h"

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
    const size_t count = size_t(4) * texture.width * texture.height;
    const bool is_right =
        texture.halves.empty() ? texture.floats.size() == count : texture.halves.size() == count;
    if (texture.width == 0 || texture.height == 0 || !is_right)
        throw Error(ErrorKind::bad_input, {fmt::format("map is {} x {} texels and holds {} bytes",
                                                       texture.width, texture.height, texture.byte_count()),
                                           texture.file, "write the image again"});
}

[[noreturn]] void refuse_texel(const Texture& texture, const TexelRectangle& rectangle) {
    for (uint32_t y = rectangle.y0; y <= rectangle.y1; ++y)
        for (uint32_t x = rectangle.x0; x <= rectangle.x1; ++x) {
            const std::array<float, 3> texel = read_texel(texture, x, y);
            for (int c = 0; c < 3; ++c)
                if (!std::isfinite(texel[c]))
                    throw Error(ErrorKind::bad_input,
                                {fmt::format("map holds {} in channel {}",
                                             std::isnan(texel[c]) ? "NaN" : "infinity", c),
                                 fmt::format("{}, pixel ({}, {})", texture.file, x, y), "repair the map"});
        }
    throw Error(ErrorKind::bad_input, {"map holds NaN or infinity", texture.file, "repair the map"});
}

ChannelRange compute_block(const Texture& texture, uint32_t block_x, uint32_t block_y) {
    const TexelRectangle block{block_x * kBlock, block_y * kBlock,
                               std::min((block_x + 1) * kBlock, texture.width) - 1,
                               std::min((block_y + 1) * kBlock, texture.height) - 1};
    const std::optional<ChannelRange> range = find_texel_range(texture, block);
    if (!range) refuse_texel(texture, block);
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
        coarse.ranges.assign(size_t(coarse.width) * coarse.height, make_empty_range());
        for (uint32_t y = 0; y < fine.height; ++y)
            for (uint32_t x = 0; x < fine.width; ++x) {
                const ChannelRange& range = fine.ranges[size_t(y) * fine.width + x];
                extend(coarse.ranges[size_t(y / 2) * coarse.width + x / 2], range.low, range.high);
            }
        pyramid.levels_.push_back(std::move(coarse));
    }
    return pyramid;
}

namespace {

/// Indices of one axis that a wrapped range reads: at most two ranges inside of the map, and perhaps the
/// outside.
struct WrappedRange {
    std::array<std::array<int64_t, 2>, 2> parts{};
    int count = 0;
    bool is_outside_read = false;

    void add(int64_t first, int64_t last) { parts[count++] = {first, last}; }
};

WrappedRange wrap_range(int64_t first, int64_t last, int64_t size, WrapMode wrap) {
    WrappedRange result;
    if (wrap == WrapMode::clamp) {
        result.add(std::clamp<int64_t>(first, 0, size - 1), std::clamp<int64_t>(last, 0, size - 1));
        return result;
    }
    if (wrap == WrapMode::black) {
        result.is_outside_read = first < 0 || last >= size;
        if (last >= 0 && first < size) result.add(std::max<int64_t>(first, 0), std::min(last, size - 1));
        return result;
    }
    if (last - first >= size - 1) {
        result.add(0, size - 1);
        return result;
    }
    const int64_t a = wrap_index(first, size, wrap), b = wrap_index(last, size, wrap);
    if (wrap == WrapMode::repeat) {
        if (a <= b) {
            result.add(a, b);
        } else {
            result.add(a, size - 1);
            result.add(0, b);
        }
        return result;
    }
    // Mirrored: the range runs up, down, or turns once at either end.
    const auto find_period = [&](int64_t index) {
        return index >= 0 ? index / size : -((size - 1 - index) / size);
    };
    const int64_t period = find_period(first);
    if (period == find_period(last)) {
        result.add(std::min(a, b), std::max(a, b));
    } else if (period % 2 == 0) {
        result.add(std::min(a, b), size - 1);
    } else {
        result.add(0, std::max(a, b));
    }
    return result;
}

} // namespace

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
