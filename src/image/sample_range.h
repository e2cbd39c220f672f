// The samples that a picture says it holds, and the picture that it says it is a part of.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "relief/image.h"

namespace relief {

/// An entry of the header; empty: there is none.
std::string read_entry(const Image& image, const std::string& key);

/// [first, last) of the header; throws Error{bad_input} without one. `part`: number, from 0, for messages.
std::pair<int, int> read_sample_range(const Image& image, size_t part);

/// x0, y0, x1, y1 (half open) of the whole picture, inside its display window; nullopt: the header does not
/// say it.
std::optional<std::array<int, 4>> read_whole_window(const Image& image);

/// Samples a pixel of the whole picture; 0: the header does not say it.
int read_whole_samples(const Image& image);

} // namespace relief
