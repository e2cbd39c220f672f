// The nearest known word to a misspelt one, for hints.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace relief {

/// "did you mean 'roughness'?" for the known word within a third of its length (Damerau 1964), or the only
/// one with this prefix of three letters; otherwise "known: a, b, c" for a short list, else empty.
std::string suggest_word(std::string_view word, std::span<const std::string_view> known);

/// Insertions, deletions, replaced letters and exchanges of neighbours that make one word of the other.
size_t compute_edit_distance(std::string_view a, std::string_view b);

} // namespace relief
