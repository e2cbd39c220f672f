#include "structures/sah_split.h"

#include <algorithm>
#include <array>

namespace relief {

namespace {

struct Bin {
    Box box;
    uint32_t count = 0;
};

using AxisBins = std::array<Bin, kMaxBinCount>;

/// Plain comparisons instead of fmin and fmax, which spend time on NaN.
void grow(Box& box, const Box& other) {
    const auto lesser = [](float a, float b) { return a < b ? a : b; };
    const auto greater = [](float a, float b) { return a > b ? a : b; };
    box.lower = {lesser(box.lower.x, other.lower.x), lesser(box.lower.y, other.lower.y),
                 lesser(box.lower.z, other.lower.z)};
    box.upper = {greater(box.upper.x, other.upper.x), greater(box.upper.y, other.upper.y),
                 greater(box.upper.z, other.upper.z)};
}

/// The one map from centroid to bin: finding and applying a split must agree to the last bit.
class BinMap {
  public:
    BinMap(const Box& centroids, int axis, int bin_count)
        : lower_(get_component(centroids.lower, axis)), last_(bin_count - 1) {
        const double extent = double(get_component(centroids.upper, axis)) - lower_;
        scale_ = extent > 0 ? bin_count / extent : 0;
    }
    bool is_flat() const { return scale_ == 0; }
    /// Always in [0, bin count): a centroid that is no number goes to bin 0.
    int compute_bin(float centroid) const {
        const double bin = (double(centroid) - lower_) * scale_;
        if (!(bin > 0)) return 0;
        return bin < last_ ? int(bin) : last_;
    }

  private:
    double lower_;
    double scale_;
    int last_;
};

SahSplit find_best_cut(const AxisBins& bins, int bin_count, uint32_t primitive_count, int axis) {
    std::array<double, kMaxBinCount> right_area{};
    Box box;
    for (int k = bin_count - 1; k > 0; --k) {
        grow(box, bins[k].box);
        right_area[k] = compute_half_area(box);
    }
    SahSplit best;
    box = {};
    uint32_t left_count = 0;
    for (int k = 1; k < bin_count; ++k) {
        grow(box, bins[k - 1].box);
        left_count += bins[k - 1].count;
        const uint32_t right_count = primitive_count - left_count;
        if (left_count == 0 || right_count == 0) continue;
        SahSplit split;
        split.cost = compute_half_area(box) * left_count + right_area[k] * right_count;
        split.axis = axis;
        split.cut = uint32_t(k);
        split.imbalance = std::max(left_count, right_count);
        if (split.is_better_than(best)) best = split;
    }
    return best;
}

void sort_along(const SplitInput& input, int axis, std::span<SweepEntry> scratch) {
    for (size_t k = 0; k < input.ids.size(); ++k) {
        const uint32_t id = input.ids[k];
        scratch[k] = {get_component(compute_centroid(input.boxes[id]), axis), id, 0};
    }
    std::sort(scratch.begin(), scratch.end(), [](const SweepEntry& a, const SweepEntry& b) {
        return a.centroid < b.centroid || (a.centroid == b.centroid && a.id < b.id);
    });
}

SahSplit sweep_along(const SplitInput& input, int axis, std::span<SweepEntry> scratch) {
    sort_along(input, axis, scratch);
    const size_t count = scratch.size();
    Box box;
    for (size_t k = count; k-- > 1;) {
        grow(box, input.boxes[scratch[k].id]);
        scratch[k].right_area = compute_half_area(box);
    }
    SahSplit best;
    box = {};
    for (size_t k = 1; k < count; ++k) {
        grow(box, input.boxes[scratch[k - 1].id]);
        SahSplit split;
        split.cost = compute_half_area(box) * double(k) + scratch[k].right_area * double(count - k);
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
    const double x = double(box.upper.x) - box.lower.x;
    const double y = double(box.upper.y) - box.lower.y;
    const double z = double(box.upper.z) - box.lower.z;
    return x * y + y * z + z * x;
}

SahSplit find_binned_split(const SplitInput& input, int bin_count) {
    std::array<AxisBins, 3> bins;
    const std::array<BinMap, 3> maps{BinMap(input.centroids, 0, bin_count),
                                     BinMap(input.centroids, 1, bin_count),
                                     BinMap(input.centroids, 2, bin_count)};
    for (const uint32_t id : input.ids) {
        const Box& box = input.boxes[id];
        const Vec3f centroid = compute_centroid(box);
        for (int axis = 0; axis < 3; ++axis) {
            Bin& bin = bins[axis][maps[axis].compute_bin(get_component(centroid, axis))];
            grow(bin.box, box);
            ++bin.count;
        }
    }
    SahSplit best;
    for (int axis = 0; axis < 3; ++axis) {
        if (maps[axis].is_flat()) continue;
        const SahSplit split = find_best_cut(bins[axis], bin_count, uint32_t(input.ids.size()), axis);
        if (split.is_better_than(best)) best = split;
    }
    return best;
}

uint32_t apply_binned_split(const SplitInput& input, const SahSplit& split, int bin_count) {
    const BinMap map(input.centroids, split.axis, bin_count);
    const auto middle = std::partition(input.ids.begin(), input.ids.end(), [&](uint32_t id) {
        const float centroid = get_component(compute_centroid(input.boxes[id]), split.axis);
        return map.compute_bin(centroid) < int(split.cut);
    });
    return uint32_t(middle - input.ids.begin());
}

SahSplit find_sweep_split(const SplitInput& input, std::span<SweepEntry> scratch) {
    SahSplit best;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(get_component(input.centroids.lower, axis) < get_component(input.centroids.upper, axis)))
            continue;
        const SahSplit split = sweep_along(input, axis, scratch);
        if (split.is_better_than(best)) best = split;
    }
    return best;
}

uint32_t apply_sweep_split(const SplitInput& input, const SahSplit& split, std::span<SweepEntry> scratch) {
    sort_along(input, split.axis, scratch);
    for (size_t k = 0; k < input.ids.size(); ++k) input.ids[k] = scratch[k].id;
    return split.cut;
}

uint32_t apply_median_split(const SplitInput& input) {
    const Vec3f& low = input.centroids.lower;
    const Vec3f& high = input.centroids.upper;
    int axis = 0;
    double widest = -1;
    for (int k = 0; k < 3; ++k) {
        const double extent = double(get_component(high, k)) - get_component(low, k);
        if (extent > widest) widest = extent, axis = k;
    }
    const size_t half = input.ids.size() / 2;
    const auto is_before = [&](uint32_t a, uint32_t b) {
        const float x = get_component(compute_centroid(input.boxes[a]), axis);
        const float y = get_component(compute_centroid(input.boxes[b]), axis);
        return x < y || (x == y && a < b);
    };
    std::nth_element(input.ids.begin(), input.ids.begin() + ptrdiff_t(half), input.ids.end(), is_before);
    return uint32_t(half);
}

} // namespace relief
