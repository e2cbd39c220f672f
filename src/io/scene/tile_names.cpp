#include "io/scene/tile_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "relief/error.h"
#include "relief/io.h"
#include "relief/scene.h"

namespace relief {

namespace fs = std::filesystem;

namespace {

constexpr int kFirstTile = 1001, kLastTile = 9999, kColumns = 10;

/// Digits of a text from `at`, at most four; moves `at` behind them.
std::optional<int> read_number(std::string_view text, size_t& at) {
    const size_t begin = at;
    int value = 0;
    for (; at < text.size() && at - begin < 4 && std::isdigit(static_cast<unsigned char>(text[at])) != 0;
         ++at)
        value = 10 * value + (text[at] - '0');
    return at == begin ? std::nullopt : std::optional<int>(value);
}

std::optional<int> read_udim(std::string_view text) {
    size_t at = 0;
    const std::optional<int> number = read_number(text, at);
    const bool is_tile = number && at == 4 && at == text.size() && *number >= kFirstTile;
    return is_tile ? number : std::nullopt;
}

/// "u3_v1" as a tile, the first one being u`first`_v`first`.
std::optional<int> read_columns(std::string_view text, int first) {
    size_t at = 1;
    if (text.empty() || text[0] != 'u') return std::nullopt;
    const std::optional<int> u = read_number(text, at);
    if (!u || text.substr(at, 2) != "_v") return std::nullopt;
    at += 2;
    const std::optional<int> v = read_number(text, at);
    if (!v || at != text.size() || *u < first || *u >= first + kColumns || *v < first) return std::nullopt;
    const int tile = kFirstTile + (*u - first) + kColumns * (*v - first);
    return tile <= kLastTile ? std::optional<int>(tile) : std::nullopt;
}

std::string format_columns(int udim, int first) {
    return fmt::format("u{}_v{}", (udim - kFirstTile) % kColumns + first,
                       (udim - kFirstTile) / kColumns + first);
}

struct TileToken {
    std::string_view text;
    std::optional<int> (*read)(std::string_view);
    std::string (*format)(int);
};
std::string format_udim(int udim) { return fmt::format("{}", udim); }

constexpr std::array<TileToken, 4> kTokens = {
    {{"<UDIM>", read_udim, format_udim},
     {"<UVTILE>", [](std::string_view text) { return read_columns(text, 1); },
      [](int udim) { return format_columns(udim, 1); }},
     {"<uvtile>", [](std::string_view text) { return read_columns(text, 0); },
      [](int udim) { return format_columns(udim, 0); }},
     {"<udim>", read_udim, format_udim}}};

const TileToken* find_token(const std::string& name) {
    for (const TileToken& token : kTokens)
        if (name.find(token.text) != std::string::npos) return &token;
    return nullptr;
}

/// The tile that a name is by a pattern with the token at `at`.
std::optional<int> match_tile(std::string_view name, std::string_view pattern, size_t at,
                              const TileToken& token) {
    const std::string_view prefix = pattern.substr(0, at), suffix = pattern.substr(at + token.text.size());
    if (name.size() <= prefix.size() + suffix.size() || !name.starts_with(prefix) || !name.ends_with(suffix))
        return std::nullopt;
    return token.read(name.substr(prefix.size(), name.size() - prefix.size() - suffix.size()));
}

std::vector<std::pair<int, fs::path>> list_tiles(const fs::path& pattern, const TileToken& token) {
    const std::string name = pattern.filename().string();
    const size_t at = name.find(token.text);
    std::vector<std::pair<int, fs::path>> tiles;
    if (at == std::string::npos) return tiles;
    const fs::path folder = pattern.has_parent_path() ? pattern.parent_path() : fs::path(".");
    std::error_code code;
    for (fs::directory_iterator it(folder, code), end; !code && it != end; it.increment(code))
        if (const auto tile = match_tile(it->path().filename().string(), name, at, token))
            tiles.emplace_back(*tile, it->path());
    std::sort(tiles.begin(), tiles.end());
    return tiles;
}

void check_tiles(const std::vector<std::pair<int, std::string>>& tiles, const std::string& pattern) {
    if (tiles.size() > size_t(kMaxMapTiles))
        throw Error(ErrorKind::bad_input,
                    {fmt::format("{} tiles: at most {} are supported", tiles.size(), kMaxMapTiles), pattern,
                     "split the mesh"});
    for (size_t k = 1; k < tiles.size(); ++k)
        if (tiles[k].first == tiles[k - 1].first)
            throw Error(ErrorKind::bad_input, {fmt::format("two files are tile {}: {} and {}", tiles[k].first,
                                                           tiles[k - 1].second, tiles[k].second),
                                               pattern, "keep one of them"});
}

/// Where a word as a token reads it stands in a name, searched from the end: a tile stands last.
std::optional<std::pair<size_t, size_t>> find_tile_word(const std::string& stem, const TileToken& token) {
    constexpr size_t kLongest = 11; // u9999_v9999
    for (size_t begin = stem.size(); begin-- > 0;) {
        const auto is_digit = [&](size_t k) {
            return std::isdigit(static_cast<unsigned char>(stem[k])) != 0;
        };
        if (begin > 0 && is_digit(begin) && is_digit(begin - 1)) continue;
        for (size_t size = std::min(kLongest, stem.size() - begin); size >= 4; --size) {
            const bool is_cut = begin + size < stem.size() && is_digit(begin + size);
            if (!is_cut && token.read(std::string_view(stem).substr(begin, size)))
                return std::pair(begin, size);
        }
    }
    return std::nullopt;
}

} // namespace

void refuse_wildcard(const fs::path& file) {
    const std::string name = file.filename().string();
    const size_t star = name.find('*');
    std::error_code code;
    if (star == std::string::npos || fs::exists(file, code)) return;
    const auto replace_star = [&](const char* by) { return std::string(name).replace(star, 1, by); };
    throw Error(ErrorKind::bad_input, {"file not found", file.string(),
                                       fmt::format("a map is one file, or tiles named {}, or frames named {}",
                                                   replace_star("<UDIM>"), replace_star("####"))});
}

bool has_tile_token(const std::string& file) { return find_token(file) != nullptr; }

std::vector<std::pair<int, fs::path>> find_tiles(const fs::path& pattern) {
    const TileToken* token = find_token(pattern.filename().string());
    const auto tiles = token ? list_tiles(pattern, *token) : std::vector<std::pair<int, fs::path>>();
    if (tiles.empty())
        throw Error(ErrorKind::bad_input,
                    {"no tile file found", pattern.string(),
                     "<UDIM> stands for the four digits 1001, 1002, ... in a file name, <UVTILE> for u1_v1, "
                     "u2_v1, ..., <uvtile> for u0_v0, u1_v0, ..."});
    std::vector<std::pair<int, std::string>> names;
    for (const auto& [udim, path] : tiles) names.emplace_back(udim, path.filename().string());
    check_tiles(names, pattern.string());
    return tiles;
}

std::vector<std::pair<int, std::string>> choose_tiles(const std::string& pattern,
                                                      const std::vector<std::string>& names) {
    std::vector<std::pair<int, std::string>> tiles;
    const TileToken* token = find_token(pattern);
    if (!token) return tiles;
    const size_t at = pattern.find(token->text);
    for (const std::string& name : names)
        if (const auto tile = match_tile(name, pattern, at, *token)) tiles.emplace_back(*tile, name);
    std::sort(tiles.begin(), tiles.end());
    check_tiles(tiles, pattern);
    return tiles;
}

fs::path make_tile_name(const fs::path& pattern, int udim) {
    std::string name = pattern.filename().string();
    if (const TileToken* token = find_token(name))
        name.replace(name.find(token->text), token->text.size(), token->format(udim));
    return pattern.parent_path() / name;
}

std::string find_tile_pattern(const fs::path& file) {
    const std::string stem = file.stem().string(), extension = file.extension().string();
    std::string best;
    size_t most = 1;
    for (const TileToken& token : kTokens) {
        const auto word = find_tile_word(stem, token);
        if (!word) continue;
        const std::string name = stem.substr(0, word->first) + std::string(token.text) +
                                 stem.substr(word->first + word->second) + extension;
        const size_t count = list_tiles(file.parent_path() / name, token).size();
        if (count > most) most = count, best = name;
    }
    return best;
}

} // namespace relief
