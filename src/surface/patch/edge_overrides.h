// The edges of patches along uv seams, whose samples come from the other side.
#pragma once

#include <bit>
#include <span>

#include "base/check.h"
#include "surface/mesh/narrow_indices.h"

namespace relief {

/// An edge and both ends of the line that carries its samples, in the patch's edge direction.
struct EdgeOverride {
    uint32_t patch_edge; ///< 4 * patch + edge
    uint32_t first, second;
};

/// A set of patch edges as one bit each, and the ends of those that are in it. Immutable once made.
class EdgeOverrides {
  public:
    EdgeOverrides() = default;
    /// `entries` rise by patch_edge, which is below 4 * patch_count.
    EdgeOverrides(std::span<const EdgeOverride> entries, size_t patch_count) {
        if (entries.empty()) return;
        bits_.resize((4 * patch_count + 63) / 64);
        for (const EdgeOverride& entry : entries) {
            bits_[entry.patch_edge >> 6] |= uint64_t(1) << (entry.patch_edge & 63);
            ends_.push_back({entry.first, entry.second});
        }
        ends_.shrink_to_fit();
        uint32_t count = 0;
        before_.reserve(bits_.size());
        for (const uint64_t word : bits_) {
            before_.push_back(count);
            count += uint32_t(std::popcount(word));
        }
    }

    size_t size() const { return ends_.size(); }
    bool empty() const { return ends_.empty(); }
    bool contains(uint32_t patch_edge) const {
        return !bits_.empty() && (bits_[patch_edge >> 6] >> (patch_edge & 63) & 1) != 0;
    }
    /// Ends of the line of an edge that is in the set.
    std::array<uint32_t, 2> ends(uint32_t patch_edge) const {
        DCHECK(contains(patch_edge));
        const size_t word = patch_edge >> 6;
        const uint64_t lower_bits = bits_[word] & ((uint64_t(1) << (patch_edge & 63)) - 1);
        return ends_[before_[word] + uint32_t(std::popcount(lower_bits))];
    }
    /// All of them, rising by patch_edge.
    std::vector<EdgeOverride> list() const {
        std::vector<EdgeOverride> entries;
        for (uint32_t word = 0; word < bits_.size(); ++word)
            for (uint64_t left = bits_[word]; left != 0; left &= left - 1) {
                const auto [first, second] = ends_[entries.size()];
                entries.push_back({64 * word + uint32_t(std::countr_zero(left)), first, second});
            }
        return entries;
    }
    /// One bit a patch edge; empty: none is in the set.
    std::span<const uint64_t> bits() const { return bits_; }
    size_t byte_count() const {
        return bits_.size() * sizeof(bits_[0]) + before_.size() * sizeof(before_[0]) + ends_.byte_count();
    }

  private:
    std::vector<uint64_t> bits_;
    std::vector<uint32_t> before_; ///< edges of the set in the words before
    NarrowIndices<2> ends_;        ///< of the edges of the set, in their order
};

} // namespace relief
