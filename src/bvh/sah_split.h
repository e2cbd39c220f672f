// Where to cut a set of boxes in two by the surface-area heuristic: binned or by a full sweep.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "bvh/numbered_box.h"

namespace relief {

/// Widths are taken in double precision: the area of a box of size 1e30 or 1e-30 is no float.
double compute_half_area(const Box& box);

struct SahSplit {
    double cost =
        std::numeric_limits<double>::infinity(); ///< half area times primitives, summed over both sides
    int axis = -1;
    uint32_t cut = 0; ///< binned: first bin of the right side; sweep: primitives on the left side
    uint32_t imbalance = std::numeric_limits<uint32_t>::max();

    bool is_valid() const { return axis >= 0; }
    bool is_better_than(const SahSplit& other) const {
        return cost < other.cost || (cost == other.cost && imbalance < other.imbalance);
    }
};

/// A set, and the box of its centroids.
struct SplitInput {
    std::span<NumberedBox> members;
    Box4 centroids;
};

/// The two halves of a set that was cut: the left one stands first.
struct SplitSets {
    uint32_t left_count = 0; ///< 0: not cut
    std::array<SetBounds, 2> bounds;
};

inline constexpr int kMaxBinCount = 64;

/// Bins centroids on all three axes (Wald 2007). Invalid when all centroids coincide.
SahSplit find_binned_split(const SplitInput& input, int bin_count);
SplitSets apply_binned_split(const SplitInput& input, const SahSplit& split, int bin_count);

struct SweepEntry {
    float centroid = 0;
    uint32_t place = 0; ///< in the set
    double right_area = 0;
};

/// As long as the set.
struct SweepScratch {
    std::span<SweepEntry> entries;
    std::span<NumberedBox> members;
};

/// Tries all cuts in the order of centroids (MacDonald and Booth 1990). Invalid when all centroids coincide.
SahSplit find_sweep_split(const SplitInput& input, const SweepScratch& scratch);
SplitSets apply_sweep_split(const SplitInput& input, const SahSplit& split, const SweepScratch& scratch);

/// Halves the set along the longest axis of the centroids, for sets that the heuristic cannot split.
SplitSets apply_median_split(const SplitInput& input);

} // namespace relief
