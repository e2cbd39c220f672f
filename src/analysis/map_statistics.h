// Numbers over all texels of a displacement map, from which its convention is guessed and mistakes are found.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "relief/scene.h"

namespace relief {

inline constexpr std::array<const char*, 3> kChannelNames = {"R", "G", "B"};

/// A texel of a map.
struct TexelPlace {
    int udim = 1001;
    uint32_t x = 0, y = 0;
};

struct ChannelStatistics {
    double low = 0, high = 0, mean = 0;
    double one_sided = 0; ///< mean offset over mean distance from the midlevel, in [-1, 1]
};

struct MapStatistics {
    SampleType type = SampleType::float32; ///< the coarsest of the tiles
    uint32_t channel_count = 0;            ///< the least of the tiles
    uint64_t texel_count = 0;
    std::array<ChannelStatistics, 3> channels;
    std::array<double, 3> midlevel{};   ///< what probably means no displacement
    bool is_centred_at_half = false;    ///< floats, none negative, around 0.5
    bool is_gray = true;                ///< R = G = B in every texel
    double normal_share = 0;            ///< share of texels that are unit vectors when read as a normal map
    uint64_t bad_count = 0;             ///< texels with a NaN or an infinity
    std::optional<TexelPlace> bad;      ///< the first of them
    std::array<double, 3> background{}; ///< what the edges of the images hold
    bool has_background = false;        ///< nearly all of the edges hold that one value
    double largest = 0;                 ///< length from the midlevel
    double usual_largest = 0;           ///< the same without the few longest
    TexelPlace largest_place;
    bool is_periodic = false; ///< opposite edges continue each other, and do not lie still
    std::string colour_tag;   ///< of the first tile that has one
    size_t used_channels() const { return channel_count < 3 ? channel_count : 3; }
};

bool is_integer_type(SampleType type);

/// One pass over the texels and one over their lengths. `midlevel`: what means no displacement, or guessed.
MapStatistics measure_map(const std::vector<MapTile>& tiles, const std::optional<Vec3f>& midlevel);

} // namespace relief
