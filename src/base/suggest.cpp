#include "base/suggest.h"

#include <algorithm>
#include <vector>

namespace relief {

size_t compute_edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::vector<size_t>> table(a.size() + 1, std::vector<size_t>(b.size() + 1));
    for (size_t i = 0; i <= a.size(); ++i) table[i][0] = i;
    for (size_t j = 0; j <= b.size(); ++j) table[0][j] = j;
    for (size_t i = 1; i <= a.size(); ++i) {
        for (size_t j = 1; j <= b.size(); ++j) {
            const size_t cost = a[i - 1] == b[j - 1] ? 0 : 1;
            size_t best = std::min({table[i - 1][j] + 1, table[i][j - 1] + 1, table[i - 1][j - 1] + cost});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                best = std::min(best, table[i - 2][j - 2] + 1);
            table[i][j] = best;
        }
    }
    return table[a.size()][b.size()];
}

namespace {

constexpr size_t kShortestStem = 3; // shortest prefix, in letters, that identifies a longer word

/// The only known word with prefix `word`; empty for none or several.
std::string_view find_only_extension(std::string_view word, std::span<const std::string_view> known) {
    const size_t dashes = std::min(word.find_first_not_of('-'), word.size());
    const auto extends = [&](std::string_view candidate) { return candidate.starts_with(word); };
    if (word.size() - dashes < kShortestStem || std::ranges::count_if(known, extends) != 1) return {};
    return *std::ranges::find_if(known, extends);
}

constexpr size_t kLongestWord = 64; // longer words are not typing mistakes
constexpr size_t kLongestList = 16;

} // namespace

std::string suggest_word(std::string_view word, std::span<const std::string_view> known) {
    std::string_view nearest;
    size_t smallest = std::max<size_t>(1, (word.size() + 2) / 3) + 1;
    if (word.size() <= kLongestWord) {
        for (const std::string_view candidate : known) {
            if (candidate.size() > kLongestWord) continue;
            const size_t distance = compute_edit_distance(word, candidate);
            if (distance < smallest) smallest = distance, nearest = candidate;
        }
    }
    if (nearest.empty()) nearest = find_only_extension(word, known);
    if (!nearest.empty()) return "did you mean '" + std::string(nearest) + "'?";
    if (known.empty() || known.size() > kLongestList) return {};
    std::string list = "known: ";
    for (size_t i = 0; i < known.size(); ++i) list += (i ? ", " : "") + std::string(known[i]);
    return list;
}

} // namespace relief
