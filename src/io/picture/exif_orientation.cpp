#include "io/picture/exif_orientation.h"

#include <array>
#include <cstring>

namespace relief {

int find_exif_orientation(std::span<const uint8_t> segment) {
    constexpr std::array<uint8_t, 6> kExif = {'E', 'x', 'i', 'f', 0, 0};
    if (segment.size() < kExif.size() || std::memcmp(segment.data(), kExif.data(), kExif.size()) != 0)
        return 0;
    return find_tiff_orientation(segment.subspan(kExif.size()));
}

int find_tiff_orientation(std::span<const uint8_t> tiff) {
    constexpr size_t kHeaderBytes = 8, kEntryBytes = 12, kOrientation = 274, kShort = 3;
    if (tiff.size() < kHeaderBytes) return 0;
    const bool is_big = tiff[0] == 'M';
    const auto read = [&](size_t at, size_t count) {
        size_t value = 0;
        if (at > tiff.size() || tiff.size() - at < count) return value;
        for (size_t k = 0; k < count; ++k) value = value << 8 | tiff[at + (is_big ? k : count - 1 - k)];
        return value;
    };
    const size_t directory = read(4, 4), entries = read(directory, 2);
    for (size_t k = 0; k < entries; ++k) {
        const size_t entry = directory + 2 + k * kEntryBytes;
        if (entry >= tiff.size()) break;
        if (read(entry, 2) == kOrientation && read(entry + 2, 2) == kShort) return int(read(entry + 8, 2));
    }
    return 0;
}

} // namespace relief
