// Tuples of indices, in half the bytes while all of them are below 2^16.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace relief {

/// Safe to read from any thread.
template <size_t kCount> class NarrowIndices {
    static constexpr uint32_t kNarrowEnd = 0x10000;
    using NarrowTuple = std::array<uint16_t, kCount>;

  public:
    using Tuple = std::array<uint32_t, kCount>;

    size_t size() const { return narrow_.empty() ? wide_.size() : narrow_.size(); }
    bool empty() const { return size() == 0; }
    Tuple operator[](size_t k) const {
        if (narrow_.empty()) return wide_[k];
        Tuple tuple;
        std::copy(narrow_[k].begin(), narrow_[k].end(), tuple.begin());
        return tuple;
    }
    void push_back(const Tuple& tuple) {
        const bool fits = std::all_of(tuple.begin(), tuple.end(), [](uint32_t k) { return k < kNarrowEnd; });
        if (!fits) widen();
        if (!fits || !wide_.empty())
            wide_.push_back(tuple);
        else
            narrow_.push_back(make_narrow(tuple));
    }
    /// `count` tuples of 0, to be set: indices are below `index_end`.
    void reset(size_t count, uint32_t index_end) {
        narrow_.assign(index_end <= kNarrowEnd ? count : 0, {});
        wide_.assign(index_end <= kNarrowEnd ? 0 : count, {});
    }
    /// Thread safe for different k.
    void set(size_t k, const Tuple& tuple) {
        if (narrow_.empty())
            wide_[k] = tuple;
        else
            narrow_[k] = make_narrow(tuple);
    }
    void shrink_to_fit() { narrow_.shrink_to_fit(), wide_.shrink_to_fit(); }
    /// Of `count` tuples of indices below `index_end`.
    static uint64_t byte_count(uint64_t count, uint64_t index_end) {
        return count * (index_end <= kNarrowEnd ? sizeof(NarrowTuple) : sizeof(Tuple));
    }
    size_t byte_count() const { return narrow_.size() * sizeof(narrow_[0]) + wide_.size() * sizeof(Tuple); }

  private:
    static NarrowTuple make_narrow(const Tuple& tuple) {
        NarrowTuple narrow;
        std::transform(tuple.begin(), tuple.end(), narrow.begin(), [](uint32_t k) { return uint16_t(k); });
        return narrow;
    }
    void widen() {
        for (size_t k = 0; k < narrow_.size(); ++k) wide_.push_back((*this)[k]);
        narrow_ = {};
    }

    std::vector<NarrowTuple> narrow_; ///< one of the two is empty
    std::vector<Tuple> wide_;
};

} // namespace relief
