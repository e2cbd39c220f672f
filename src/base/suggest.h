// The nearest known word to a misspelt one, for hints.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace relief {

/// "did you mean 'roughness'?" for a word within a third of its length (at least one edit) of a known one, or
/// for a prefix of three letters or more of only one word; otherwise "known: a, b, c" for a short list, else
/// empty. Distance: Damerau-Levenshtein (Damerau 1964). Lives in relief_io.
std::string suggest_word(std::string_view word, std::span<const std::string_view> known);

/// Insertions, deletions, replaced letters and exchanges of neighbours that make one word of the other.
size_t compute_edit_distance(std::string_view a, std::string_view b);

} // namespace relief
