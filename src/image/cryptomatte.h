// Cryptomatte 1.2 (Friedman and Jones 2015, Fully automatic ID mattes; specification by Psyop, 2017): the
// numbers that stand for names, and how they lie in a picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace relief {

/// Layers of a picture, each named like its type in the header.
inline constexpr const char* kObjectMattes = "CryptoObject";
inline constexpr const char* kMaterialMattes = "CryptoMaterial";

/// Mattes that a pixel holds; two a layer of four channels.
inline constexpr size_t kMatteRanks = 6;

/// MurmurHash3_x86_32 with seed 0 (Appleby 2011).
uint32_t hash_name(std::string_view name);

/// Bits of the float that stands for a name: its hash, but for one bit where that would be no normal number.
/// Never 0, which stands for nothing.
uint32_t make_matte_id(std::string_view name);

/// "CryptoObject00.r", ...: the id of a rank, its coverage, those of the next. In lower case as the
/// specification has them, since lossy codecs of EXR take R, G and B for colours.
std::vector<std::string> name_matte_channels(const std::string& layer);

/// What a header says of a layer: its name, how ids are made, and the ids of all names.
void add_matte_entries(const std::string& layer, const std::map<std::string, uint32_t>& ids,
                       std::map<std::string, std::string>& entries);

/// What a matte has of a pixel: samples.
struct MatteShare {
    uint32_t id = 0; ///< 0: nothing
    double samples = 0;
};

/// Sorts the shares and writes the ranks of one pixel: 2 * kMatteRanks floats. Equal shares go by id, so that
/// the order of samples does not matter.
void write_matte_ranks(std::span<MatteShare> shares, double sample_count, float* target);

} // namespace relief
