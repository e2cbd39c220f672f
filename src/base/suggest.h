// The nearest known word to a misspelt one, for hints.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace relief {

/// "did you mean 'roughness'?" for a word within a third of its length (at least one edit) of a known one, or
/// for a prefix of three letters or more of only one word; otherwise "known: a, b, c" for a short list, else
/// empty. Distance: Damerau-Levenshtein (Damerau 1964). Lives in relief_io.
std::string suggest_word(std::string_view word, std::span<const std::string_view> known);

} // namespace relief
