#include "image/cryptomatte.h"

#include <algorithm>
#include <bit>

#include <fmt/format.h>

namespace relief {

namespace {

uint32_t mix_block(uint32_t k) { return std::rotl(k * 0xcc9e2d51u, 15) * 0x1b873593u; }

/// Up to four bytes, the first one lowest.
uint32_t read_block(std::string_view bytes) {
    uint32_t block = 0;
    for (size_t k = 0; k < bytes.size(); ++k) block |= uint32_t(uint8_t(bytes[k])) << (8 * k);
    return block;
}

/// A JSON string; other bytes than these stand for themselves in UTF-8.
std::string quote(std::string_view text) {
    std::string quoted = "\"";
    for (const char c : text) {
        if (uint8_t(c) < 0x20)
            quoted += fmt::format("\\u{:04x}", uint8_t(c));
        else if (c == '"' || c == '\\')
            (quoted += '\\') += c;
        else
            quoted += c;
    }
    return quoted += '"';
}

} // namespace

uint32_t hash_name(std::string_view name) {
    uint32_t hash = 0;
    std::string_view rest = name;
    for (; rest.size() >= 4; rest.remove_prefix(4))
        hash = std::rotl(hash ^ mix_block(read_block(rest.substr(0, 4))), 13) * 5 + 0xe6546b64u;
    hash ^= mix_block(read_block(rest)) ^ uint32_t(name.size());
    hash = (hash ^ hash >> 16) * 0x85ebca6bu;
    hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
    return hash ^ hash >> 16;
}

uint32_t make_matte_id(std::string_view name) {
    const uint32_t hash = hash_name(name), exponent = hash >> 23 & 255;
    return exponent == 0 || exponent == 255 ? hash ^ 1u << 23 : hash;
}

std::vector<std::string> name_matte_channels(const std::string& layer) {
    std::vector<std::string> names;
    for (size_t k = 0; k < kMatteRanks / 2; ++k)
        for (const char suffix : {'r', 'g', 'b', 'a'})
            names.push_back(fmt::format("{}{:02}.{}", layer, k, suffix));
    return names;
}

void add_matte_entries(const std::string& layer, const std::map<std::string, uint32_t>& ids,
                       std::map<std::string, std::string>& entries) {
    std::string manifest;
    for (const auto& [name, id] : ids)
        manifest += fmt::format("{}{}:\"{:08x}\"", manifest.empty() ? "" : ",", quote(name), id);
    const std::string key = "cryptomatte/" + fmt::format("{:08x}", make_matte_id(layer)).substr(0, 7) + "/";
    entries[key + "name"] = layer;
    entries[key + "hash"] = "MurmurHash3_32";
    entries[key + "conversion"] = "uint32_to_float32";
    entries[key + "manifest"] = "{" + manifest + "}";
}

void write_matte_ranks(std::span<MatteShare> shares, double sample_count, float* target) {
    std::ranges::sort(shares, [](const MatteShare& a, const MatteShare& b) {
        return a.samples > b.samples || (a.samples == b.samples && a.id < b.id);
    });
    for (size_t k = 0; k < kMatteRanks; ++k) {
        const MatteShare share = k < shares.size() ? shares[k] : MatteShare{};
        const bool is_seen = share.samples > 0;
        target[2 * k] = std::bit_cast<float>(is_seen ? share.id : 0u);
        target[2 * k + 1] = is_seen ? float(share.samples / sample_count) : 0.0f;
    }
}

} // namespace relief
