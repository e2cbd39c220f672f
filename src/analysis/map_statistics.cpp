#include "analysis/map_statistics.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "surface/map/texels.h"

namespace relief {

namespace {

using Texel = std::array<float, 3>;

bool is_finite_texel(const Texel& texel) {
    return std::isfinite(texel[0]) && std::isfinite(texel[1]) && std::isfinite(texel[2]);
}

/// Of 0..1 read as -1..1, as normal maps are stored.
bool is_unit_normal(const Texel& texel) {
    double squared = 0;
    for (const float value : texel) squared += (2.0 * value - 1) * (2.0 * value - 1);
    return texel[2] > 0.5f && std::fabs(std::sqrt(squared) - 1) < 0.05;
}

template <class Visit> void visit_texels(const std::vector<MapTile>& tiles, const Visit& visit) {
    for (const MapTile& tile : tiles)
        for (uint32_t y = 0; y < tile.texture->height; ++y)
            for (uint32_t x = 0; x < tile.texture->width; ++x)
                visit(TexelPlace{tile.udim, x, y}, read_texel(*tile.texture, x, y));
}

void measure_values(const std::vector<MapTile>& tiles, MapStatistics& statistics) {
    for (size_t c = 0; c < statistics.used_channels(); ++c)
        statistics.channels[c].low = std::numeric_limits<double>::infinity(),
        statistics.channels[c].high = -statistics.channels[c].low;
    uint64_t normal_count = 0;
    visit_texels(tiles, [&](const TexelPlace& place, const Texel& texel) {
        ++statistics.texel_count;
        if (!is_finite_texel(texel)) {
            if (statistics.bad_count++ == 0) statistics.bad = place;
            return;
        }
        for (size_t c = 0; c < statistics.used_channels(); ++c) {
            ChannelStatistics& channel = statistics.channels[c];
            channel.low = std::min(channel.low, double(texel[c]));
            channel.high = std::max(channel.high, double(texel[c]));
            channel.mean += texel[c];
        }
        statistics.is_gray &= texel[0] == texel[1] && texel[1] == texel[2];
        normal_count += is_unit_normal(texel);
    });
    const double good = double(statistics.texel_count - statistics.bad_count);
    if (good == 0) {
        statistics.channels = {};
        return;
    }
    for (ChannelStatistics& channel : statistics.channels) channel.mean /= good;
    statistics.normal_share = double(normal_count) / good;
}

bool lies_around_half(const MapStatistics& statistics) {
    const auto end = statistics.channels.begin() + ptrdiff_t(statistics.used_channels());
    return std::all_of(statistics.channels.begin(), end, [](const ChannelStatistics& channel) {
        return channel.low >= 0 && channel.high <= 1.05 && channel.mean > 0.35 && channel.mean < 0.65;
    });
}

/// Texels on the edges of a tile, the corners first.
template <class Visit> void visit_edges(const Texture& texture, const Visit& visit) {
    const uint32_t right = texture.width - 1, bottom = texture.height - 1;
    for (uint32_t x = 0; x <= right; ++x) visit(x, 0u), visit(x, bottom);
    for (uint32_t y = 0; y <= bottom; ++y) visit(0u, y), visit(right, y);
}

void measure_background(const std::vector<MapTile>& tiles, MapStatistics& statistics) {
    constexpr double kTolerance = 0.01, kShare = 0.95;
    const Texel corner = read_texel(*tiles.front().texture, 0, 0);
    double range = 0;
    for (const ChannelStatistics& channel : statistics.channels)
        range = std::max(range, channel.high - channel.low);
    uint64_t alike = 0, all = 0;
    for (const MapTile& tile : tiles)
        visit_edges(*tile.texture, [&](uint32_t x, uint32_t y) {
            const Texel texel = read_texel(*tile.texture, x, y);
            ++all;
            alike += std::fabs(double(texel[0]) - corner[0]) <= kTolerance * range &&
                     std::fabs(double(texel[1]) - corner[1]) <= kTolerance * range &&
                     std::fabs(double(texel[2]) - corner[2]) <= kTolerance * range;
        });
    statistics.background = {corner[0], corner[1], corner[2]};
    statistics.has_background = is_finite_texel(corner) && double(alike) >= kShare * double(all);
}

/// Lengths from the midlevel: the largest, and the largest but for one texel in 10000, four at least.
void measure_lengths(const std::vector<MapTile>& tiles, MapStatistics& statistics) {
    std::vector<float> lengths;
    lengths.reserve(statistics.texel_count);
    std::array<double, 3> distance{};
    visit_texels(tiles, [&](const TexelPlace& place, const Texel& texel) {
        if (!is_finite_texel(texel)) return;
        double squared = 0;
        for (size_t c = 0; c < statistics.used_channels(); ++c) {
            const double offset = double(texel[c]) - statistics.midlevel[c];
            squared += offset * offset;
            distance[c] += std::fabs(offset);
        }
        const double length = std::sqrt(squared);
        if (length > statistics.largest) statistics.largest = length, statistics.largest_place = place;
        lengths.push_back(float(length));
    });
    if (lengths.empty()) return;
    for (size_t c = 0; c < 3; ++c) {
        ChannelStatistics& channel = statistics.channels[c];
        const double offset = (channel.mean - statistics.midlevel[c]) * double(lengths.size());
        channel.one_sided = distance[c] > 0 ? offset / distance[c] : 0;
    }
    const size_t skipped = std::min(lengths.size() - 1, std::max<size_t>(4, lengths.size() / 10000));
    std::nth_element(lengths.begin(), lengths.begin() + ptrdiff_t(skipped), lengths.end(), std::greater<>());
    statistics.usual_largest = lengths[skipped];
}

double compute_distance(const Texel& a, const Texel& b) {
    return std::fabs(double(a[0]) - b[0]) + std::fabs(double(a[1]) - b[1]) + std::fabs(double(a[2]) - b[2]);
}

/// Whether the steps from the last column and row to the first are like the steps beside them.
bool continues_across_edges(const Texture& texture) {
    constexpr double kLikeness = 2;
    if (texture.width < 8 || texture.height < 8) return false;
    const uint32_t right = texture.width - 1, bottom = texture.height - 1;
    double across = 0, beside = 0;
    for (uint32_t y = 0; y <= bottom; ++y) {
        across += compute_distance(read_texel(texture, 0, y), read_texel(texture, right, y));
        beside += compute_distance(read_texel(texture, 0, y), read_texel(texture, 1, y));
    }
    for (uint32_t x = 0; x <= right; ++x) {
        across += compute_distance(read_texel(texture, x, 0), read_texel(texture, x, bottom));
        beside += compute_distance(read_texel(texture, x, 0), read_texel(texture, x, 1));
    }
    return beside > 0 && across < kLikeness * beside;
}

/// The coarsest of two types of samples.
SampleType pick_coarser(SampleType a, SampleType b) {
    constexpr int kRanks[] = {0, 2, 3, 1, 4}; // halves are coarser than 16-bit integers
    return kRanks[size_t(b)] < kRanks[size_t(a)] ? b : a;
}

} // namespace

bool is_integer_type(SampleType type) {
    return type == SampleType::uint8 || type == SampleType::uint16 || type == SampleType::uint32;
}

MapStatistics measure_map(const std::vector<MapTile>& tiles, const std::optional<Vec3f>& midlevel) {
    MapStatistics statistics;
    statistics.type = tiles.front().texture->source_type;
    statistics.channel_count = tiles.front().texture->channel_count;
    for (const MapTile& tile : tiles) {
        statistics.type = pick_coarser(statistics.type, tile.texture->source_type);
        statistics.channel_count = std::min(statistics.channel_count, tile.texture->channel_count);
        if (statistics.colour_tag.empty()) statistics.colour_tag = tile.texture->colour_tag;
    }
    measure_values(tiles, statistics);
    statistics.is_centred_at_half = statistics.bad_count < statistics.texel_count &&
                                    !is_integer_type(statistics.type) && lies_around_half(statistics);
    if (midlevel)
        statistics.midlevel = {midlevel->x, midlevel->y, midlevel->z};
    else if (is_integer_type(statistics.type) || statistics.is_centred_at_half)
        statistics.midlevel = {0.5, 0.5, 0.5};
    measure_background(tiles, statistics);
    measure_lengths(tiles, statistics);
    statistics.is_periodic = tiles.size() == 1 && !statistics.has_background && !statistics.is_gray &&
                             continues_across_edges(*tiles.front().texture);
    return statistics;
}

} // namespace relief
