// The samples that a picture says it holds.
#pragma once

#include <cstddef>
#include <utility>

#include "relief/image.h"

namespace relief {

/// [first, last) of the header; throws Error{bad_input} without one. `part`: number, from 0, for messages.
std::pair<int, int> read_sample_range(const Image& image, size_t part);

} // namespace relief
