// The orientation in the Exif data of a JPEG or PNG file.
#pragma once

#include <cstdint>
#include <span>

namespace relief {

/// Value of the tag Orientation in an APP1 segment (Exif 2.3, 4.7.2); 0: there is none.
int find_exif_orientation(std::span<const uint8_t> segment);

/// The same in Exif data without the name in front of it, as in an eXIf chunk of PNG.
int find_tiff_orientation(std::span<const uint8_t> tiff);

} // namespace relief
