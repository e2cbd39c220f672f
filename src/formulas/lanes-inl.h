// Sixteen (or eight, or four) floats as one value: in one, two or four registers, or emulated. Compiled once
// per target by Highway, inside HWY_NAMESPACE. Nothing is fused: bit-identical on all targets.
#if defined(RELIEF_MATH_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELIEF_MATH_LANES_INL_H
#undef RELIEF_MATH_LANES_INL_H
#else
#define RELIEF_MATH_LANES_INL_H
#endif

#include <bit>
#include <cstring>
#include <iterator>
#include <type_traits>

#include <hwy/highway.h>

#include "math/vec.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Inlined whatever the compiler thinks of it. Not in kernels without SIMD, where each lane is an operation
/// of its own: they would take six times as long to compile, and are no faster for it.
#undef RELIEF_INLINE
#if HWY_TARGET == HWY_EMU128
#define RELIEF_INLINE inline
#else
#define RELIEF_INLINE HWY_INLINE
#endif

/// Body of a function of registers: register `p` of a Result is the expression.
#define RELIEF_RETURN_PARTS(Result, ...)                                                                     \
    Result r;                                                                                                \
    for (size_t p = 0; p < std::size(r.part); ++p) r.part[p] = __VA_ARGS__;                                  \
    return r

/// One bit per lane.
using LaneMask = uint32_t;

template <size_t kWidth> struct Lanes {
    using D = hn::CappedTag<float, kWidth>;
    using V = hn::Vec<D>;
    static constexpr size_t kLanes = hn::MaxLanes(D());
    static constexpr size_t kParts = kWidth / kLanes;

    V part[kParts];

    Lanes() = default;
    RELIEF_INLINE explicit Lanes(float value) {
        for (size_t p = 0; p < kParts; ++p) part[p] = hn::Set(D(), value);
    }
    static RELIEF_INLINE Lanes load(const float* aligned) {
        RELIEF_RETURN_PARTS(Lanes, hn::Load(D(), aligned + p * kLanes));
    }
    static RELIEF_INLINE Lanes load_unaligned(const float* source) {
        RELIEF_RETURN_PARTS(Lanes, hn::LoadU(D(), source + p * kLanes));
    }
    /// Sixteen (or eight, ...) pairs of numbers in structure-of-arrays layout.
    static RELIEF_INLINE void load_pairs(const float* source, Lanes& first, Lanes& second) {
        for (size_t p = 0; p < kParts; ++p)
            hn::LoadInterleaved2(D(), source + 2 * p * kLanes, first.part[p], second.part[p]);
    }
    /// origin + code * scale of a quantised box. The scale is a power of two: exact, fused or not.
    static RELIEF_INLINE Lanes decode(const uint8_t* codes, float origin, float scale) {
        const hn::Rebind<uint8_t, D> d8;
        const hn::Rebind<int32_t, D> d32;
        Lanes r;
        for (size_t p = 0; p < kParts; ++p) {
            const V code = hn::ConvertTo(D(), hn::PromoteTo(d32, hn::LoadU(d8, codes + p * kLanes)));
            r.part[p] = hn::MulAdd(code, hn::Set(D(), scale), hn::Set(D(), origin));
        }
        return r;
    }
    RELIEF_INLINE void store(float* aligned) const {
        for (size_t p = 0; p < kParts; ++p) hn::Store(part[p], D(), aligned + p * kLanes);
    }
    RELIEF_INLINE void store_unaligned(float* target) const {
        for (size_t p = 0; p < kParts; ++p) hn::StoreU(part[p], D(), target + p * kLanes);
    }
    /// floor, as 32-bit integers in memory.
    RELIEF_INLINE void store_as_integers(int32_t* aligned) const {
        const hn::Rebind<int32_t, D> d32;
        for (size_t p = 0; p < kParts; ++p) hn::Store(hn::ConvertTo(d32, part[p]), d32, aligned + p * kLanes);
    }
};

#define RELIEF_LANES_BINARY(name, function)                                                                  \
    template <size_t W> RELIEF_INLINE Lanes<W> name(const Lanes<W>& a, const Lanes<W>& b) {                  \
        RELIEF_RETURN_PARTS(Lanes<W>, hn::function(a.part[p], b.part[p]));                                   \
    }
RELIEF_LANES_BINARY(operator+, Add)
RELIEF_LANES_BINARY(operator-, Sub)
RELIEF_LANES_BINARY(operator*, Mul)
RELIEF_LANES_BINARY(operator/, Div)
RELIEF_LANES_BINARY(min, Min)
RELIEF_LANES_BINARY(max, Max)
#undef RELIEF_LANES_BINARY

template <size_t W> RELIEF_INLINE Lanes<W> magnitude(const Lanes<W>& a) { return max(a, Lanes<W>(0.0f) - a); }

template <size_t W> RELIEF_INLINE Lanes<W> floor(const Lanes<W>& a) {
    RELIEF_RETURN_PARTS(Lanes<W>, hn::Floor(a.part[p]));
}

/// Converts mask and number through one word: mixed byte and word accesses defeat store-to-load forwarding.
static_assert(std::endian::native == std::endian::little);
template <class D, class M> RELIEF_INLINE LaneMask to_bits(D d, M mask) {
    alignas(8) uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, mask, bytes);
    std::conditional_t<(hn::MaxLanes(D()) > 8), uint16_t, uint8_t> bits;
    std::memcpy(&bits, bytes, sizeof(bits));
    return bits;
}

/// Compress store of the lanes in `mask`. Writes whole registers: memory behind is undefined.
template <class D>
RELIEF_INLINE void store_compressed(D d, hn::Vec<D> v, LaneMask mask, hn::TFromD<D>* target) {
    const uint64_t bits = mask;
    hn::StoreU(hn::CompressBits(v, reinterpret_cast<const uint8_t*>(&bits)), d, target);
}

#define RELIEF_LANES_COMPARE(name, function)                                                                 \
    template <size_t W> RELIEF_INLINE LaneMask name(const Lanes<W>& a, const Lanes<W>& b) {                  \
        LaneMask bits = 0;                                                                                   \
        for (size_t p = 0; p < Lanes<W>::kParts; ++p)                                                        \
            bits |= to_bits(typename Lanes<W>::D(), hn::function(a.part[p], b.part[p]))                      \
                    << (p * Lanes<W>::kLanes);                                                               \
        return bits;                                                                                         \
    }
RELIEF_LANES_COMPARE(less_equal, Le)
RELIEF_LANES_COMPARE(less, Lt)
RELIEF_LANES_COMPARE(equal, Eq)
RELIEF_LANES_COMPARE(not_equal, Ne) // NaN: true or false, depending on the instruction set
#undef RELIEF_LANES_COMPARE

/// a where x < y, else b.
template <size_t W>
RELIEF_INLINE Lanes<W> select_less(const Lanes<W>& x, const Lanes<W>& y, const Lanes<W>& a,
                                   const Lanes<W>& b) {
    RELIEF_RETURN_PARTS(Lanes<W>, hn::IfThenElse(hn::Lt(x.part[p], y.part[p]), a.part[p], b.part[p]));
}

// The order of summation is unspecified.
#define RELIEF_LANES_REDUCE(name, function, of_lanes)                                                        \
    template <size_t W> RELIEF_INLINE float name(const Lanes<W>& a) {                                        \
        auto all = a.part[0];                                                                                \
        for (size_t p = 1; p < Lanes<W>::kParts; ++p) all = hn::function(all, a.part[p]);                    \
        return hn::GetLane(hn::of_lanes(typename Lanes<W>::D(), all));                                       \
    }
RELIEF_LANES_REDUCE(reduce_min, Min, MinOfLanes)
RELIEF_LANES_REDUCE(reduce_max, Max, MaxOfLanes)
RELIEF_LANES_REDUCE(reduce_sum, Add, SumOfLanes)
#undef RELIEF_LANES_REDUCE

/// Lanes in [0, +inf) or in (-inf, 0] in all three: the sign test of a watertight triangle.
template <size_t W>
RELIEF_INLINE LaneMask same_side(const Lanes<W>& u, const Lanes<W>& v, const Lanes<W>& w) {
    const Lanes<W> zero(0.0f);
    return less_equal(zero, min(min(u, v), w)) | less_equal(max(max(u, v), w), zero);
}

using Lanes16 = Lanes<16>;

/// Sixteen integers: non-negative lane indices, or words to be stored.
struct LaneIndices {
    using D = hn::Rebind<int32_t, Lanes16::D>;
    hn::Vec<D> part[Lanes16::kParts];

    LaneIndices() = default;
    RELIEF_INLINE explicit LaneIndices(int32_t value) {
        for (auto& p : part) p = hn::Set(D(), value);
    }
    static RELIEF_INLINE LaneIndices load(const uint32_t* source) {
        const hn::RebindToUnsigned<D> d;
        RELIEF_RETURN_PARTS(LaneIndices, hn::BitCast(D(), hn::LoadU(d, source + p * Lanes16::kLanes)));
    }
    RELIEF_INLINE void store(int32_t* aligned) const {
        for (size_t p = 0; p < Lanes16::kParts; ++p) hn::Store(part[p], D(), aligned + p * Lanes16::kLanes);
    }
    RELIEF_INLINE LaneIndices operator+(const LaneIndices& other) const {
        RELIEF_RETURN_PARTS(LaneIndices, hn::Add(part[p], other.part[p]));
    }
    /// The bits of floats.
    RELIEF_INLINE explicit LaneIndices(const Lanes16& bits) {
        for (size_t p = 0; p < Lanes16::kParts; ++p) part[p] = hn::BitCast(D(), bits.part[p]);
    }
    /// From integer-valued floats.
    static RELIEF_INLINE LaneIndices convert(const Lanes16& whole) {
        RELIEF_RETURN_PARTS(LaneIndices, hn::ConvertTo(D(), whole.part[p]));
    }
    RELIEF_INLINE Lanes16 bits() const { RELIEF_RETURN_PARTS(Lanes16, hn::BitCast(Lanes16::D(), part[p])); }
    RELIEF_INLINE Lanes16 to_floats() const {
        RELIEF_RETURN_PARTS(Lanes16, hn::ConvertTo(Lanes16::D(), part[p]));
    }
    template <int kBits> RELIEF_INLINE LaneIndices shifted_up() const {
        RELIEF_RETURN_PARTS(LaneIndices, hn::ShiftLeft<kBits>(part[p]));
    }
    template <int kBits> RELIEF_INLINE LaneIndices shifted_down() const {
        RELIEF_RETURN_PARTS(LaneIndices, hn::ShiftRight<kBits>(part[p]));
    }
    RELIEF_INLINE LaneIndices masked(int32_t bits) const {
        RELIEF_RETURN_PARTS(LaneIndices, hn::And(part[p], hn::Set(D(), bits)));
    }
};

/// Lanes of `a` where the integer is negative, else of `b`.
RELIEF_INLINE Lanes16 select_negative(const LaneIndices& number, const Lanes16& a, const Lanes16& b) {
    Lanes16 r;
    for (size_t p = 0; p < Lanes16::kParts; ++p) {
        const auto is_negative = hn::Lt(number.part[p], hn::Zero(LaneIndices::D()));
        r.part[p] = hn::IfThenElse(hn::RebindMask(Lanes16::D(), is_negative), a.part[p], b.part[p]);
    }
    return r;
}

/// Gathers base[index] in every lane.
RELIEF_INLINE Lanes16 gather(const float* base, const LaneIndices& index) {
    RELIEF_RETURN_PARTS(Lanes16, hn::GatherIndex(Lanes16::D(), base, index.part[p]));
}

/// Table of kCount floats (8 or 16), indexed per lane: a permutation if two registers hold it, else a gather.
template <size_t kCount> struct LaneTable {
    using Values = Lanes<kCount>;
    static constexpr bool kIsInRegisters = Lanes16::kLanes >= 8;
    Values lanes;
    alignas(64) float stored[kIsInRegisters ? 1 : kCount];

    RELIEF_INLINE explicit LaneTable(const Values& values) : lanes(values) {
        if constexpr (!kIsInRegisters) values.store(stored);
    }
    RELIEF_INLINE Lanes16 pick(const LaneIndices& index) const {
        if constexpr (kIsInRegisters) {
            RELIEF_RETURN_PARTS(Lanes16, look_up(*this, index.part[p]));
        } else {
            return gather(stored, index);
        }
    }

  private:
    /// `table` is *this: a template, so that each instruction set compiles its own branch only.
    template <class Table, class Index> static RELIEF_INLINE auto look_up(const Table& table, Index index) {
        const Lanes16::D d;
        const hn::Rebind<int32_t, Lanes16::D> d32;
        if constexpr (Table::Values::kLanes < Lanes16::kLanes) {
            const auto values = hn::Combine(d, table.lanes.part[0], table.lanes.part[0]);
            return hn::TableLookupLanes(values, hn::IndicesFromVec(d, index));
        } else if constexpr (Table::Values::kParts == 1) {
            return hn::TableLookupLanes(table.lanes.part[0], hn::IndicesFromVec(d, index));
        } else if constexpr (Table::Values::kParts == 2) {
            const auto last = hn::Set(d32, int32_t(Lanes16::kLanes - 1));
            const auto within = hn::IndicesFromVec(d, hn::And(index, last));
            return hn::IfThenElse(hn::RebindMask(d, hn::Gt(index, last)),
                                  hn::TableLookupLanes(table.lanes.part[1], within),
                                  hn::TableLookupLanes(table.lanes.part[0], within));
        }
    }
};

using Lanes8 = Lanes<8>;
using Lanes4 = Lanes<4>;

/// The first half of the lanes, and the others.
template <size_t W> RELIEF_INLINE void split(const Lanes<W>& all, Lanes<W / 2>& low, Lanes<W / 2>& high) {
    if constexpr (Lanes<W>::kParts == Lanes<W / 2>::kParts) {
        const typename Lanes<W / 2>::D d;
        low.part[0] = hn::LowerHalf(d, all.part[0]), high.part[0] = hn::UpperHalf(d, all.part[0]);
    } else {
        for (size_t p = 0; p < Lanes<W / 2>::kParts; ++p)
            low.part[p] = all.part[p], high.part[p] = all.part[Lanes<W / 2>::kParts + p];
    }
}

/// Four floats per lane, lane after lane.
struct LaneQuads {
    alignas(64) float lane[16][4];

    RELIEF_INLINE void transpose(Lanes16& a, Lanes16& b, Lanes16& c, Lanes16& d) const {
        for (size_t p = 0; p < Lanes16::kParts; ++p)
            hn::LoadInterleaved4(Lanes16::D(), lane[p * Lanes16::kLanes], a.part[p], b.part[p], c.part[p],
                                 d.part[p]);
    }
    RELIEF_INLINE void set(const Lanes16& a, const Lanes16& b, const Lanes16& c, const Lanes16& d) {
        for (size_t p = 0; p < Lanes16::kParts; ++p)
            hn::StoreInterleaved4(a.part[p], b.part[p], c.part[p], d.part[p], Lanes16::D(),
                                  lane[p * Lanes16::kLanes]);
    }
};

/// The shared formulas over sixteen lanes.
namespace wide {
using Float = Lanes16;
#define RELIEF_LANES
#include "formulas/displace.h"
#undef RELIEF_LANES
} // namespace wide

/// The same formulas over the four channels of a texel.
namespace texel {
using Float = Lanes4;
#define RELIEF_LANES
#include "formulas/displace.h"
#undef RELIEF_LANES
} // namespace texel

/// The same formulas over the channels of two texels.
namespace texel_pair {
using Float = Lanes8;
#define RELIEF_LANES
#include "formulas/displace.h"
#undef RELIEF_LANES
} // namespace texel_pair

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
