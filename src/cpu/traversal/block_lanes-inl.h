// The vertices of a block of 4 x 2 micro-quads in registers, and the corners of its triangles out of them.
#if defined(RELIEF_BLOCK_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELIEF_BLOCK_LANES_INL_H
#undef RELIEF_BLOCK_LANES_INL_H
#else
#define RELIEF_BLOCK_LANES_INL_H
#endif

#include "formulas/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// One coordinate of the fifteen vertices of a block, row by row: `first` is its first vertex in a grid with
/// `columns` vertices a row. Lane 15 is any number; reads up to one number past the last vertex.
RELIEF_INLINE Lanes16 load_block(const float* first, uint32_t columns) {
    constexpr size_t kRow = 5;
    const Lanes16::D d;
    // Where the lanes of each row would begin if they were the first of all.
    const float* const second = first + columns - kRow;
    const float* const third = second + columns - kRow;
    Lanes16 r;
    for (size_t p = 0; p < Lanes16::kParts; ++p) {
        const size_t begin = p * Lanes16::kLanes, end = begin + Lanes16::kLanes;
        auto v = hn::LoadU(d, (begin < kRow ? first : begin < 2 * kRow ? second : third) + begin);
        if (begin < kRow && kRow < end)
            v = hn::IfThenElse(hn::FirstN(d, kRow - begin), v, hn::LoadU(d, second + begin));
        if (begin < 2 * kRow && 2 * kRow < end)
            v = hn::IfThenElse(hn::FirstN(d, 2 * kRow - begin), v, hn::LoadU(d, third + begin));
        r.part[p] = v;
    }
    return r;
}

/// The vertices of a block with lane 15 like lane 0.
RELIEF_INLINE Lanes16 hide_last(const Lanes16& vertex) {
    const Lanes16::D d;
    Lanes16 r = vertex;
    auto& last = r.part[Lanes16::kParts - 1];
    last = hn::IfThenElse(hn::FirstN(d, Lanes16::kLanes - 1), last, hn::Set(d, hn::GetLane(vertex.part[0])));
    return r;
}

/// One corner of a block's eight quads out of two registers, the first kFromFirst from the first one.
template <size_t kFromFirst, size_t W>
RELIEF_INLINE auto pick_corner(const Lanes<W>& vertex, const int32_t (&number_in_register)[8]) {
    const Lanes8::D d;
    const auto index = hn::SetTableIndices(d, number_in_register);
    return hn::IfThenElse(hn::FirstN(d, kFromFirst), hn::TableLookupLanes(vertex.part[0], index),
                          hn::TableLookupLanes(vertex.part[1], index));
}

/// The three corners of sixteen triangles of a block, one coordinate: lanes 0..7 are (00, 10, 11), 8..15 (00,
/// 11, 01) of cells 0..3 of the first row, then of the second.
template <size_t W>
RELIEF_INLINE void gather_corners(const Lanes<W>& vertex, Lanes<W>& a, Lanes<W>& b, Lanes<W>& c) {
    static_assert(W == 16);
    if constexpr (Lanes<W>::kParts == 1) {
        alignas(64) static constexpr int32_t kA[16] = {0, 1, 2, 3, 5, 6, 7, 8, 0, 1, 2, 3, 5, 6, 7, 8};
        alignas(64) static constexpr int32_t kB[16] = {1, 2, 3, 4, 6, 7, 8, 9, 6, 7, 8, 9, 11, 12, 13, 14};
        alignas(64) static constexpr int32_t kC[16] = {6, 7, 8, 9, 11, 12, 13, 14,
                                                       5, 6, 7, 8, 10, 11, 12, 13};
        const Lanes16::D d;
        a.part[0] = hn::TableLookupLanes(vertex.part[0], hn::SetTableIndices(d, kA));
        b.part[0] = hn::TableLookupLanes(vertex.part[0], hn::SetTableIndices(d, kB));
        c.part[0] = hn::TableLookupLanes(vertex.part[0], hn::SetTableIndices(d, kC));
    } else if constexpr (Lanes<W>::kParts == 2) {
        // Not through memory: loads across two stores have to wait for them.
        alignas(32) static constexpr int32_t k00[8] = {0, 1, 2, 3, 5, 6, 7, 0},
                                             k10[8] = {1, 2, 3, 4, 6, 7, 0, 1},
                                             k11[8] = {6, 7, 0, 1, 3, 4, 5, 6},
                                             k01[8] = {5, 6, 7, 0, 2, 3, 4, 5};
        a.part[0] = a.part[1] = pick_corner<7>(vertex, k00);
        b.part[0] = pick_corner<6>(vertex, k10);
        c.part[0] = b.part[1] = pick_corner<2>(vertex, k11);
        c.part[1] = pick_corner<3>(vertex, k01);
    } else {
        alignas(64) float v[16], p00[8], p10[8], p11[8], p01[8];
        vertex.store(v);
        for (int row = 0; row < 2; ++row) {
            Lanes4::load_unaligned(v + 5 * row).store(p00 + 4 * row);
            Lanes4::load_unaligned(v + 5 * row + 1).store(p10 + 4 * row);
            Lanes4::load_unaligned(v + 5 * row + 6).store(p11 + 4 * row);
            Lanes4::load_unaligned(v + 5 * row + 5).store(p01 + 4 * row);
        }
        constexpr size_t kHalf = 8 / Lanes16::kLanes;
        for (size_t p = 0; p < kHalf; ++p) {
            const Lanes16::D d;
            const size_t at = p * Lanes16::kLanes;
            a.part[p] = a.part[kHalf + p] = hn::Load(d, p00 + at);
            b.part[p] = hn::Load(d, p10 + at);
            c.part[p] = b.part[kHalf + p] = hn::Load(d, p11 + at);
            c.part[kHalf + p] = hn::Load(d, p01 + at);
        }
    }
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
