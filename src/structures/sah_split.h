// Where to cut a set of boxes in two by the surface-area heuristic: binned or by a full sweep.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "math/box.h"

namespace relief {

/// Widths are taken in double precision: the area of a box of size 1e30 or 1e-30 is no float.
double compute_half_area(const Box& box);

inline Vec3f compute_centroid(const Box& box) { return box.lower * 0.5f + box.upper * 0.5f; }

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

/// Primitives `ids` of `boxes`, and the box of their centroids.
struct SplitInput {
    std::span<const Box> boxes;
    std::span<uint32_t> ids;
    Box centroids;
};

inline constexpr int kMaxBinCount = 64;

/// Bins centroids on all three axes (Wald 2007). Invalid when all centroids coincide.
SahSplit find_binned_split(const SplitInput& input, int bin_count);
/// Moves the left side to the front of `ids`; returns its size.
uint32_t apply_binned_split(const SplitInput& input, const SahSplit& split, int bin_count);

struct SweepEntry {
    float centroid = 0;
    uint32_t id = 0;
    double right_area = 0;
};

/// Tries every cut between neighbours in the order of centroids (MacDonald and Booth 1990). `scratch` is as
/// long as `ids`. Invalid when all centroids coincide.
SahSplit find_sweep_split(const SplitInput& input, std::span<SweepEntry> scratch);
uint32_t apply_sweep_split(const SplitInput& input, const SahSplit& split, std::span<SweepEntry> scratch);

/// Halves the set along the longest axis of the centroids, for sets that the heuristic cannot split.
uint32_t apply_median_split(const SplitInput& input);

} // namespace relief
