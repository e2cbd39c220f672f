#include "analysis/map_survey.h"

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

void survey_values(const std::vector<MapTile>& tiles, MapSurvey& survey) {
    for (size_t c = 0; c < survey.used_channels(); ++c)
        survey.channels[c].low = std::numeric_limits<double>::infinity(),
        survey.channels[c].high = -survey.channels[c].low;
    uint64_t normal_count = 0;
    visit_texels(tiles, [&](const TexelPlace& place, const Texel& texel) {
        ++survey.texel_count;
        if (!is_finite_texel(texel)) {
            if (survey.bad_count++ == 0) survey.bad = place;
            return;
        }
        for (size_t c = 0; c < survey.used_channels(); ++c) {
            ChannelSurvey& channel = survey.channels[c];
            channel.low = std::min(channel.low, double(texel[c]));
            channel.high = std::max(channel.high, double(texel[c]));
            channel.mean += texel[c];
        }
        survey.is_gray &= texel[0] == texel[1] && texel[1] == texel[2];
        normal_count += is_unit_normal(texel);
    });
    const double good = double(survey.texel_count - survey.bad_count);
    if (good == 0) {
        survey.channels = {};
        return;
    }
    for (ChannelSurvey& channel : survey.channels) channel.mean /= good;
    survey.normal_share = double(normal_count) / good;
}

bool lies_around_half(const MapSurvey& survey) {
    const auto end = survey.channels.begin() + ptrdiff_t(survey.used_channels());
    return std::all_of(survey.channels.begin(), end, [](const ChannelSurvey& channel) {
        return channel.low >= 0 && channel.high <= 1.05 && channel.mean > 0.35 && channel.mean < 0.65;
    });
}

/// Texels on the edges of a tile, the corners first.
template <class Visit> void visit_edges(const Texture& texture, const Visit& visit) {
    const uint32_t right = texture.width - 1, bottom = texture.height - 1;
    for (uint32_t x = 0; x <= right; ++x) visit(x, 0u), visit(x, bottom);
    for (uint32_t y = 0; y <= bottom; ++y) visit(0u, y), visit(right, y);
}

void survey_background(const std::vector<MapTile>& tiles, MapSurvey& survey) {
    constexpr double kTolerance = 0.01, kShare = 0.95;
    const Texel corner = read_texel(*tiles.front().texture, 0, 0);
    double range = 0;
    for (const ChannelSurvey& channel : survey.channels) range = std::max(range, channel.high - channel.low);
    uint64_t alike = 0, all = 0;
    for (const MapTile& tile : tiles)
        visit_edges(*tile.texture, [&](uint32_t x, uint32_t y) {
            const Texel texel = read_texel(*tile.texture, x, y);
            ++all;
            alike += std::fabs(double(texel[0]) - corner[0]) <= kTolerance * range &&
                     std::fabs(double(texel[1]) - corner[1]) <= kTolerance * range &&
                     std::fabs(double(texel[2]) - corner[2]) <= kTolerance * range;
        });
    survey.background = {corner[0], corner[1], corner[2]};
    survey.has_background = is_finite_texel(corner) && double(alike) >= kShare * double(all);
}

/// Lengths from the midlevel: the largest, and the largest but for one texel in 10000, four at least.
void survey_lengths(const std::vector<MapTile>& tiles, MapSurvey& survey) {
    std::vector<float> lengths;
    lengths.reserve(survey.texel_count);
    std::array<double, 3> distance{};
    visit_texels(tiles, [&](const TexelPlace& place, const Texel& texel) {
        if (!is_finite_texel(texel)) return;
        double squared = 0;
        for (size_t c = 0; c < survey.used_channels(); ++c) {
            const double offset = double(texel[c]) - survey.midlevel[c];
            squared += offset * offset;
            distance[c] += std::fabs(offset);
        }
        const double length = std::sqrt(squared);
        if (length > survey.largest) survey.largest = length, survey.largest_place = place;
        lengths.push_back(float(length));
    });
    if (lengths.empty()) return;
    for (size_t c = 0; c < 3; ++c) {
        ChannelSurvey& channel = survey.channels[c];
        const double offset = (channel.mean - survey.midlevel[c]) * double(lengths.size());
        channel.one_sided = distance[c] > 0 ? offset / distance[c] : 0;
    }
    const size_t skipped = std::min(lengths.size() - 1, std::max<size_t>(4, lengths.size() / 10000));
    std::nth_element(lengths.begin(), lengths.begin() + ptrdiff_t(skipped), lengths.end(), std::greater<>());
    survey.usual_largest = lengths[skipped];
}

double compute_distance(const Texel& a, const Texel& b) {
    return std::fabs(double(a[0]) - b[0]) + std::fabs(double(a[1]) - b[1]) + std::fabs(double(a[2]) - b[2]);
}

/// Whether the step from the last column to the first, and from the last row to the first, is like the steps
/// beside it.
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
    const auto rank = [](SampleType type) {
        switch (type) {
        case SampleType::uint8:
            return 0;
        case SampleType::float16:
            return 1;
        case SampleType::uint16:
            return 2;
        case SampleType::uint32:
            return 3;
        case SampleType::float32:
            break;
        }
        return 4;
    };
    return rank(b) < rank(a) ? b : a;
}

} // namespace

bool is_integer_type(SampleType type) {
    return type == SampleType::uint8 || type == SampleType::uint16 || type == SampleType::uint32;
}

MapSurvey survey_map(const std::vector<MapTile>& tiles, const std::optional<Vec3f>& midlevel) {
    MapSurvey survey;
    survey.type = tiles.front().texture->source_type;
    survey.channel_count = tiles.front().texture->channel_count;
    for (const MapTile& tile : tiles) {
        survey.type = pick_coarser(survey.type, tile.texture->source_type);
        survey.channel_count = std::min(survey.channel_count, tile.texture->channel_count);
        if (survey.colour_tag.empty()) survey.colour_tag = tile.texture->colour_tag;
    }
    survey_values(tiles, survey);
    survey.is_centred_at_half =
        survey.bad_count < survey.texel_count && !is_integer_type(survey.type) && lies_around_half(survey);
    if (midlevel)
        survey.midlevel = {midlevel->x, midlevel->y, midlevel->z};
    else if (is_integer_type(survey.type) || survey.is_centred_at_half)
        survey.midlevel = {0.5, 0.5, 0.5};
    survey_background(tiles, survey);
    survey_lengths(tiles, survey);
    survey.is_periodic = tiles.size() == 1 && !survey.has_background && !survey.is_gray &&
                         continues_across_edges(*tiles.front().texture);
    return survey;
}

} // namespace relief
