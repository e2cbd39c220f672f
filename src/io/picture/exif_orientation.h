// The orientation in the Exif data of a JPEG file.
#pragma once

#include <cstdint>
#include <span>

namespace relief {

/// Value of the tag Orientation in an APP1 segment (Exif 2.3, 4.7.2); 0: there is none.
int find_exif_orientation(std::span<const uint8_t> segment);

} // namespace relief
