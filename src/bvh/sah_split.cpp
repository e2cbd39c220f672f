#include "bvh/sah_split.h"

#include <algorithm>
#include <utility>

namespace relief {

namespace {

/// Of all three axes. Counts of empty bins are what tells their boxes apart from others.
struct Bins {
    Box4 box[3][kMaxBinCount];
    uint32_t count[3][kMaxBinCount];

    explicit Bins(int bin_count) {
        for (int axis = 0; axis < 3; ++axis)
            for (int k = 0; k < bin_count; ++k) box[axis][k] = {}, count[axis][k] = 0;
    }
};

/// The one map from centroids to bins: finding and applying a split must agree to the last bit.
class BinMap {
  public:
    BinMap(const Box4& centroids, int bin_count)
        : lower_(centroids.lower), last_(Float4{} + float(bin_count - 1)) {
        for (int axis = 0; axis < 3; ++axis) {
            const double extent = double(centroids.upper[axis]) - centroids.lower[axis];
            // Sets that are too small for a finite factor end in the first bin.
            scale_[axis] = extent > 0 ? float(std::min(bin_count / extent, 3e38)) : 0;
        }
    }
    bool is_flat(int axis) const { return scale_[axis] == 0; }
    /// Always in [0, bin count): a NaN centroid goes to bin 0.
    Int4 compute_bins(Float4 centroid) const {
        const Float4 bin = get_greater((centroid - lower_) * scale_, Float4{});
        return __builtin_convertvector(get_lesser(bin, last_), Int4);
    }

  private:
    Float4 lower_, scale_{}, last_;
};

SahSplit find_best_cut(const Bins& bins, int bin_count, uint32_t primitive_count, int axis) {
    double right_area[kMaxBinCount];
    Box4 box;
    uint32_t right_count = 0;
    for (int k = bin_count - 1; k > 0; --k) {
        box.extend(bins.box[axis][k]);
        right_count += bins.count[axis][k];
        right_area[k] = right_count > 0 ? box.half_area() : 0;
    }
    SahSplit best;
    box = {};
    uint32_t left_count = 0;
    for (int k = 1; k < bin_count; ++k) {
        box.extend(bins.box[axis][k - 1]);
        left_count += bins.count[axis][k - 1];
        right_count = primitive_count - left_count;
        if (left_count == 0 || right_count == 0) continue;
        SahSplit split;
        split.cost = box.half_area() * left_count + right_area[k] * right_count;
        split.axis = axis;
        split.cut = uint32_t(k);
        split.imbalance = std::max(left_count, right_count);
        if (split.is_better_than(best)) best = split;
    }
    return best;
}

/// Bounds of both sides of a set that is in order already.
SplitSets measure_sets(std::span<const NumberedBox> members, uint32_t left_count) {
    SplitSets sets;
    sets.left_count = left_count;
    for (size_t k = 0; k < members.size(); ++k) sets.bounds[k < left_count ? 0 : 1].extend(members[k]);
    return sets;
}

void sort_along(const SplitInput& input, int axis, std::span<SweepEntry> entries) {
    for (size_t k = 0; k < input.members.size(); ++k)
        entries[k] = {compute_centroid(input.members[k])[axis], uint32_t(k), 0};
    std::sort(entries.begin(), entries.end(), [&](const SweepEntry& a, const SweepEntry& b) {
        return a.centroid < b.centroid ||
               (a.centroid == b.centroid && input.members[a.place].id < input.members[b.place].id);
    });
}

SahSplit sweep_along(const SplitInput& input, int axis, std::span<SweepEntry> entries) {
    sort_along(input, axis, entries);
    const size_t count = entries.size();
    const auto extend = [&](Box4& box, size_t k) {
        const NumberedBox& member = input.members[entries[k].place];
        box.extend(make_float4(member.lower), make_float4(member.upper));
    };
    Box4 box;
    for (size_t k = count; k-- > 1;) {
        extend(box, k);
        entries[k].right_area = box.half_area();
    }
    SahSplit best;
    box = {};
    for (size_t k = 1; k < count; ++k) {
        extend(box, k - 1);
        SahSplit split;
        split.cost = box.half_area() * double(k) + entries[k].right_area * double(count - k);
        split.axis = axis;
        split.cut = uint32_t(k);
        split.imbalance = uint32_t(std::max(k, count - k));
        if (split.is_better_than(best)) best = split;
    }
    return best;
}

} // namespace

double compute_half_area(const Box& box) {
    if (box.is_empty()) return 0;
    return Box4{make_float4(box.lower), make_float4(box.upper)}.half_area();
}

SahSplit find_binned_split(const SplitInput& input, int bin_count) {
    Bins bins(bin_count);
    const BinMap map(input.centroids, bin_count);
    for (const NumberedBox& member : input.members) {
        const Float4 low = make_float4(member.lower), high = make_float4(member.upper);
        const Int4 bin = map.compute_bins(low * 0.5f + high * 0.5f);
        for (int axis = 0; axis < 3; ++axis) {
            bins.box[axis][bin[axis]].extend(low, high);
            ++bins.count[axis][bin[axis]];
        }
    }
    SahSplit best;
    for (int axis = 0; axis < 3; ++axis) {
        if (map.is_flat(axis)) continue;
        const SahSplit split = find_best_cut(bins, bin_count, uint32_t(input.members.size()), axis);
        if (split.is_better_than(best)) best = split;
    }
    return best;
}

SplitSets apply_binned_split(const SplitInput& input, const SahSplit& split, int bin_count) {
    const BinMap map(input.centroids, bin_count);
    const auto is_left = [&](const NumberedBox& member) {
        return map.compute_bins(compute_centroid(member))[split.axis] < int(split.cut);
    };
    SetBounds left, right;
    NumberedBox* const members = input.members.data();
    size_t begin = 0, end = input.members.size();
    while (true) {
        for (; begin < end && is_left(members[begin]); ++begin) left.extend(members[begin]);
        for (; begin < end && !is_left(members[end - 1]); --end) right.extend(members[end - 1]);
        if (begin == end) break;
        std::swap(members[begin], members[end - 1]);
        left.extend(members[begin++]);
        right.extend(members[--end]);
    }
    return {uint32_t(begin), {left, right}};
}

SahSplit find_sweep_split(const SplitInput& input, const SweepScratch& scratch) {
    SahSplit best;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(input.centroids.lower[axis] < input.centroids.upper[axis])) continue;
        const SahSplit split = sweep_along(input, axis, scratch.entries);
        if (split.is_better_than(best)) best = split;
    }
    return best;
}

SplitSets apply_sweep_split(const SplitInput& input, const SahSplit& split, const SweepScratch& scratch) {
    sort_along(input, split.axis, scratch.entries);
    std::copy(input.members.begin(), input.members.end(), scratch.members.begin());
    for (size_t k = 0; k < input.members.size(); ++k)
        input.members[k] = scratch.members[scratch.entries[k].place];
    return measure_sets(input.members, split.cut);
}

SplitSets apply_median_split(const SplitInput& input) {
    int axis = 0;
    double widest = -1;
    for (int k = 0; k < 3; ++k) {
        const double extent = double(input.centroids.upper[k]) - input.centroids.lower[k];
        if (extent > widest) widest = extent, axis = k;
    }
    const size_t half = input.members.size() / 2;
    const auto is_before = [&](const NumberedBox& a, const NumberedBox& b) {
        const float x = compute_centroid(a)[axis], y = compute_centroid(b)[axis];
        return x < y || (x == y && a.id < b.id);
    };
    std::nth_element(input.members.begin(), input.members.begin() + ptrdiff_t(half), input.members.end(),
                     is_before);
    return measure_sets(input.members, uint32_t(half));
}

} // namespace relief
