// UDIM numbers of the unit squares of the uv plane: 1001 + column + 10 row.
#pragma once

#include <cmath>
#include <optional>

namespace relief {

inline constexpr int kFirstUdim = 1001, kLastUdim = 9999; ///< four digits
inline constexpr int kUdimColumns = 10, kUdimRows = 900;  ///< the last row ends one column early

/// Uvs of files with few digits have errors of this size: a face reaches into a tile only if it does so by
/// more.
inline constexpr double kUvRounding = 1e-5;

/// The UDIM number of the tile that a uv is in; nothing where u is outside of [0, 10), v is negative, or the
/// number has more than four digits.
inline std::optional<int> find_udim(double u, double v) {
    const double column = std::floor(u), row = std::floor(v);
    if (!(column >= 0 && column < kUdimColumns && row >= 0 && row < kUdimRows)) return std::nullopt;
    const int udim = kFirstUdim + int(column) + kUdimColumns * int(row);
    return udim <= kLastUdim ? std::optional(udim) : std::nullopt;
}

/// The place of a tile in the uv plane: its lower corner.
struct UdimSquare {
    int column, row;
};

/// `udim`: kFirstUdim or greater.
constexpr UdimSquare find_udim_square(int udim) {
    return {(udim - kFirstUdim) % kUdimColumns, (udim - kFirstUdim) / kUdimColumns};
}

} // namespace relief
