#include "lab/trees/morton_order.h"

#include <algorithm>
#include <array>

#include "base/check.h"
#include "base/parallel.h"
#include "formulas/morton.h"

namespace relief {

namespace {

/// Blocks of the sort; their size, not the threads, decides who counts what.
constexpr size_t kBlock = 32768;
constexpr int kDigitBits = 8;
constexpr size_t kDigits = size_t(1) << kDigitBits;

using Histogram = std::array<uint32_t, kDigits>;

Box compute_scene_box(std::span<const Box> boxes) {
    std::vector<Box> parts((boxes.size() + kBlock - 1) / kBlock);
    parallel_for("scene box", parts.size(), 1, [&](size_t begin, size_t end) {
        for (size_t part = begin; part < end; ++part)
            for (size_t k = part * kBlock; k < std::min(boxes.size(), (part + 1) * kBlock); ++k)
                parts[part].extend(boxes[k]);
    });
    Box all;
    for (const Box& part : parts) all.extend(part);
    return all;
}

/// Stable sort by eight bits a pass, least significant first.
class RadixSort {
  public:
    explicit RadixSort(MortonOrder& order)
        : order_(order),
          codes_(order.codes.size()),
          ids_(order.ids.size()),
          places_((order.codes.size() + kBlock - 1) / kBlock) {}

    void run(int code_bits) {
        for (int shift = 0; shift < code_bits; shift += kDigitBits) {
            count(shift);
            if (!find_places()) continue;
            scatter(shift);
            order_.codes.swap(codes_);
            order_.ids.swap(ids_);
        }
    }

  private:
    size_t block_end(size_t block) const { return std::min(order_.codes.size(), (block + 1) * kBlock); }

    void count(int shift) {
        parallel_for("count digits", places_.size(), 1, [&](size_t begin, size_t end) {
            for (size_t block = begin; block < end; ++block) {
                places_[block].fill(0);
                for (size_t k = block * kBlock; k < block_end(block); ++k)
                    ++places_[block][(order_.codes[k] >> shift) % kDigits];
            }
        });
    }

    /// From counts to first places; false: one digit has all, and nothing would move.
    bool find_places() {
        uint32_t place = 0;
        bool is_mixed = false;
        for (size_t digit = 0; digit < kDigits; ++digit) {
            const uint32_t first = place;
            for (Histogram& histogram : places_) {
                const uint32_t items = histogram[digit];
                histogram[digit] = place;
                place += items;
            }
            is_mixed |= place != first && place - first != order_.codes.size();
        }
        return is_mixed;
    }

    void scatter(int shift) {
        parallel_for("scatter", places_.size(), 1, [&](size_t begin, size_t end) {
            for (size_t block = begin; block < end; ++block)
                for (size_t k = block * kBlock; k < block_end(block); ++k) {
                    const uint32_t place = places_[block][(order_.codes[k] >> shift) % kDigits]++;
                    codes_[place] = order_.codes[k];
                    ids_[place] = order_.ids[k];
                }
        });
    }

    MortonOrder& order_;
    std::vector<uint64_t> codes_;
    std::vector<uint32_t> ids_;
    std::vector<Histogram> places_; ///< of each block
};

} // namespace

MortonOrder compute_morton_order(std::span<const Box> boxes, int code_bits) {
    DCHECK(code_bits == 30 || code_bits == 63);
    MortonOrder order;
    order.scene = compute_scene_box(boxes);
    order.codes.resize(boxes.size());
    order.ids.resize(boxes.size());
    parallel_for("codes", boxes.size(), kBlock, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            const Vec3f centre = scalar::centre_of_box(boxes[k].lower, boxes[k].upper);
            const scalar::MortonCode code =
                code_bits == 30 ? scalar::make_morton30(centre, order.scene.lower, order.scene.upper)
                                : scalar::make_morton63(centre, order.scene.lower, order.scene.upper);
            order.codes[k] = uint64_t(code.high) << 32 | code.low;
            order.ids[k] = uint32_t(k);
        }
    });
    RadixSort(order).run(code_bits);
    return order;
}

} // namespace relief
