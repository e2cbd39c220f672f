// How linear light looks on a screen: the display transform of PNG files as a table.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "relief/types.h"

namespace relief::viewer {

/// Display transforms that write_image knows: the first is the default.
inline constexpr const char* kDisplayNames[] = {"agx", "aces", "filmic", "standard", "raw"};

/// To [0, 1]; NaN becomes 0.
inline float clamp_to_unit(float value) { return value > 0 ? std::min(value, 1.0f) : 0.0f; }

inline uint8_t round_to_byte(float value) { return uint8_t(clamp_to_unit(value) * 255 + 0.5f); }

class DisplayTable {
  public:
    /// The curve of sRGB alone, which needs no table.
    DisplayTable() = default;
    /// Has a picture of all colours written and read again, in a temporary file. Throws as check_tone_map and
    /// write_image.
    explicit DisplayTable(const std::string& name);

    /// Bytes of red, green and blue for linear light.
    void show(const Vec3f& linear, uint8_t* bytes) const;

  private:
    std::vector<Vec3f> entries_; ///< values of the screen, [0, 1]; red changes fastest; empty: no table
};

} // namespace relief::viewer
