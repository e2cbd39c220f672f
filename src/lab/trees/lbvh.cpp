#include "lab/trees/lbvh.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "base/check.h"
#include "base/parallel.h"
#include "formulas/morton.h"
#include "formulas/tree.h"
#include "lab/trees/morton_order.h"

namespace relief {

namespace {

constexpr uint32_t kMaxPrimitiveCount = 1u << 30;

/// A subtree with fewer primitives is built by one thread.
constexpr uint32_t kParallelLeaves = 8192;
constexpr size_t kGrain = 16384;

/// Entries [begin, end), not empty.
struct Range {
    uint32_t begin, end;
    uint32_t count() const { return end - begin; }
    uint32_t last() const { return end - 1; }
};

/// Where a range is cut: its right part begins at `cut`.
struct Cut {
    uint32_t cut;
    uint8_t axis;
};

void grow(Box& box, const Box& other) {
    const auto get_lesser = [](float a, float b) { return a < b ? a : b; };
    const auto get_greater = [](float a, float b) { return a > b ? a : b; };
    box.lower = {get_lesser(box.lower.x, other.lower.x), get_lesser(box.lower.y, other.lower.y),
                 get_lesser(box.lower.z, other.lower.z)};
    box.upper = {get_greater(box.upper.x, other.upper.x), get_greater(box.upper.y, other.upper.y),
                 get_greater(box.upper.z, other.upper.z)};
}

Box join(const Box& a, const Box& b) {
    Box all = a;
    grow(all, b);
    return all;
}

Box compute_range_box(std::span<const Box> boxes, const std::vector<uint32_t>& ids, const Range& range) {
    Box box;
    for (uint32_t k = range.begin; k < range.end; ++k) grow(box, boxes[ids[k]]);
    return box;
}

/// By the highest bit in which the codes differ; they do.
Cut cut_by_code(const std::vector<uint64_t>& codes, const Range& range) {
    const uint64_t first = codes[range.begin], last = codes[range.last()];
    const int bit = std::bit_width(first ^ last) - 1;
    const uint64_t least = last >> bit << bit;
    const auto begin = codes.begin() + range.begin, end = codes.begin() + range.end;
    const auto found = std::lower_bound(begin, end, least);
    return {range.begin + uint32_t(found - begin), uint8_t(scalar::axis_of_morton_bit(uint32_t(bit)))};
}

/// By the highest bit in which the numbers of the entries differ.
Cut cut_by_number(const Range& range) {
    const int bit = std::bit_width(range.begin ^ range.last()) - 1;
    return {range.last() >> bit << bit, 0};
}

template <class Left, class Right>
void build_parts(uint32_t count, const Left& build_left, const Right& build_right) {
    if (count >= kParallelLeaves) return parallel_invoke(build_left, build_right);
    build_left();
    build_right();
}

class CompactBuild {
  public:
    CompactBuild(std::span<const Box> boxes, const LbvhBuilder::Config& config)
        : boxes_(boxes),
          max_leaf_size_(config.max_leaf_size),
          order_(compute_morton_order(boxes, config.code_bits)) {}

    AxisBvh run() {
        number_cuts();
        const uint32_t count = uint32_t(boxes_.size());
        result_.bvh.nodes.resize(1 + 2 * size_t(cut_count_));
        result_.axes.resize(result_.bvh.nodes.size());
        result_.depth = build_node({0, count}, 0).depth;
        result_.bvh.primitive_ids = std::move(order_.ids);
        return std::move(result_);
    }

  private:
    /// Whether a node's right child starts at `entry` > 0.
    bool is_cut(uint32_t entry) const {
        const std::vector<uint64_t>& codes = order_.codes;
        const uint64_t code = codes[entry];
        if (codes[entry - 1] != code) return true;
        // The node cut here holds entries of this code whose numbers agree above the lowest bit of `entry`.
        const uint32_t most = std::min(entry & (0u - entry), max_leaf_size_);
        uint32_t count = 0, right = 0;
        while (count < most && entry - count > 0 && codes[entry - count - 1] == code) ++count;
        while (right < most && entry + right < codes.size() && codes[entry + right] == code) ++right;
        return count + right > max_leaf_size_;
    }

    void number_cuts() {
        numbers_.resize(boxes_.size());
        parallel_for("cuts", boxes_.size(), kGrain, [&](size_t begin, size_t end) {
            for (size_t k = std::max<size_t>(begin, 1); k < end; ++k) numbers_[k] = is_cut(uint32_t(k));
        });
        for (uint32_t& number : numbers_) {
            const uint32_t is_used = number;
            number = cut_count_;
            cut_count_ += is_used;
        }
    }

    struct Subtree {
        Box box;
        int depth = 0; ///< edges on the longest way down
    };

    Subtree build_node(const Range& range, uint32_t slot) {
        BvhNode& node = result_.bvh.nodes[slot];
        const bool is_one_code = order_.codes[range.begin] == order_.codes[range.last()];
        if (is_one_code && range.count() <= max_leaf_size_) {
            const Box box = compute_range_box(boxes_, order_.ids, range);
            node = {box.lower, range.begin, box.upper, range.count()};
            return {box, 0};
        }
        const Cut cut = is_one_code ? cut_by_number(range) : cut_by_code(order_.codes, range);
        const uint32_t left_slot = 1 + 2 * numbers_[cut.cut];
        result_.axes[slot] = cut.axis;
        Subtree left, right;
        const auto build_left = [&] { left = build_node({range.begin, cut.cut}, left_slot); };
        const auto build_right = [&] { right = build_node({cut.cut, range.end}, left_slot + 1); };
        build_parts(range.count(), build_left, build_right);
        const Box box = join(left.box, right.box);
        node = {box.lower, left_slot, box.upper, 0};
        return {box, 1 + std::max(left.depth, right.depth)};
    }

    std::span<const Box> boxes_;
    uint32_t max_leaf_size_;
    MortonOrder order_;
    std::vector<uint32_t> numbers_; ///< of each entry: cuts before it
    uint32_t cut_count_ = 0;
    AxisBvh result_;
};

class HeapBuild {
  public:
    HeapBuild(std::span<const Box> boxes, int code_bits, int levels)
        : boxes_(boxes), order_(compute_morton_order(boxes, code_bits)), levels_(levels) {}

    DenseHeap run() {
        TreeNode none{};
        none.word = scalar::kEmptySlot;
        heap_.nodes.assign(size_t(1) << levels_, none);
        heap_.levels = levels_;
        build_node({0, uint32_t(boxes_.size())}, 1);
        heap_.primitive_ids = std::move(order_.ids);
        return std::move(heap_);
    }

  private:
    Box build_node(const Range& range, uint32_t key) {
        TreeNode& node = heap_.nodes[key];
        const bool is_last_level = int(std::bit_width(key)) == levels_;
        if (is_last_level || order_.codes[range.begin] == order_.codes[range.last()]) {
            const Box box = compute_range_box(boxes_, order_.ids, range);
            node = {box.lower, range.begin, box.upper, range.count()};
            return box;
        }
        const Cut cut = cut_by_code(order_.codes, range);
        Box left, right;
        const auto build_left = [&] { left = build_node({range.begin, cut.cut}, 2 * key); };
        const auto build_right = [&] { right = build_node({cut.cut, range.end}, 2 * key + 1); };
        build_parts(range.count(), build_left, build_right);
        const Box box = join(left, right);
        node = {box.lower, 0, box.upper, scalar::make_inner_word(cut.axis)};
        return box;
    }

    std::span<const Box> boxes_;
    MortonOrder order_;
    int levels_;
    DenseHeap heap_;
};

} // namespace

AxisBvh LbvhBuilder::build(std::span<const Box> boxes, const Config& config) {
    DCHECK(config.max_leaf_size >= 1 && config.max_leaf_size <= scalar::kNodeCountMask);
    if (boxes.empty()) return {};
    check_primitive_count(boxes.size(), kMaxPrimitiveCount, "linear BVH",
                          "split the scene into instances of several meshes");
    return CompactBuild(boxes, config).run();
}

DenseHeap LbvhBuilder::build_heap(std::span<const Box> boxes, const HeapConfig& config) {
    DCHECK(config.levels >= 0 && config.levels <= DenseHeap::kMaxLevels);
    if (boxes.empty()) return {};
    check_primitive_count(boxes.size(), scalar::kNodeCountMask, "linear BVH as a heap",
                          "build it without a heap, or split the mesh");
    const int levels = config.levels > 0 ? config.levels : choose_heap_levels(boxes.size());
    return HeapBuild(boxes, config.code_bits, levels).run();
}

int choose_heap_levels(size_t primitive_count) {
    const int levels = int(std::bit_width(std::max<size_t>(primitive_count, 1) - 1)) + 2;
    return std::min(levels, DenseHeap::kMaxLevels);
}

} // namespace relief
