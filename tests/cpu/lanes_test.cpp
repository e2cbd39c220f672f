// What kernels are made of, lane by lane: masks and numbers, compressed stores, tables and the corners of
// blocks go other ways on every instruction set.

#include "math/lane_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cpu/lanes_test.cpp"
#include <hwy/foreach_target.h>

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "cpu/traversal/block_lanes-inl.h"
#include "support/targets.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {
namespace {

std::string target_name() { return hwy::TargetName(HWY_TARGET); }

template <size_t W> void check_masks() {
    for (uint32_t bits = 0; bits < 1u << W; bits += W == 16 ? 37 : 1) {
        alignas(64) float values[W];
        for (size_t k = 0; k < W; ++k) values[k] = (bits >> k & 1) != 0 ? 1.0f : 0.0f;
        const Lanes<W> lanes = Lanes<W>::load(values), half(0.5f);
        ASSERT_EQ(less(half, lanes), bits) << target_name();
        ASSERT_EQ(equal(lanes, Lanes<W>(1.0f)), bits) << target_name();
        ASSERT_EQ(equal(lanes, Lanes<W>(0.0f)), ~bits & ((1u << W) - 1)) << target_name();
        ASSERT_EQ(not_equal(lanes, Lanes<W>(0.0f)), bits) << target_name();
    }
}

void check_numbers_that_are_none() {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Lanes16 none(nan), one(1.0f);
    for (const auto& [a, b] : {std::pair(none, one), std::pair(one, none), std::pair(none, none)}) {
        EXPECT_EQ(equal(a, b), 0u) << target_name();
        EXPECT_EQ(less(a, b), 0u) << target_name();
        EXPECT_EQ(less_equal(a, b), 0u) << target_name();
    }
}

void check_compressed_stores() {
    using D = hn::RebindToUnsigned<Lanes16::D>;
    constexpr size_t kLanes = Lanes16::kLanes;
    alignas(64) uint32_t source[kLanes];
    for (size_t k = 0; k < kLanes; ++k) source[k] = uint32_t(100 + k);
    for (uint32_t bits = 0; bits < 1u << kLanes; bits += kLanes == 16 ? 41 : 1) {
        alignas(64) uint32_t target[2 * kLanes] = {};
        store_compressed(D(), hn::Load(D(), source), bits, target + 1);
        size_t count = 1;
        for (size_t k = 0; k < kLanes; ++k)
            if ((bits >> k & 1) != 0) {
                ASSERT_EQ(target[count], source[k]) << target_name() << " " << bits;
                ++count;
            }
        ASSERT_EQ(target[0], 0u) << target_name();
    }
}

template <size_t kCount> void check_table() {
    alignas(64) float values[kCount];
    for (size_t k = 0; k < kCount; ++k) values[k] = 0.5f + float(k);
    const LaneTable<kCount> table(Lanes<kCount>::load(values));
    for (uint32_t step = 0; step < kCount; ++step) {
        alignas(64) uint32_t index[16];
        alignas(64) float found[16];
        for (uint32_t k = 0; k < 16; ++k) index[k] = (k * step + 3) % kCount;
        table.pick(LaneIndices::load(index)).store(found);
        for (size_t k = 0; k < 16; ++k) ASSERT_EQ(found[k], values[index[k]]) << target_name();
    }
}

void check_corners() {
    alignas(64) float vertices[16], corner[3][16];
    for (size_t k = 0; k < 16; ++k) vertices[k] = float(k);
    Lanes16 a, b, c;
    gather_corners(Lanes16::load(vertices), a, b, c);
    a.store(corner[0]), b.store(corner[1]), c.store(corner[2]);
    for (size_t quad = 0; quad < 8; ++quad) {
        const float first = float(quad / 4 * 5 + quad % 4);
        const float expected[2][3] = {{first, first + 1, first + 6}, {first, first + 6, first + 5}};
        for (size_t upper = 0; upper < 2; ++upper)
            for (size_t k = 0; k < 3; ++k)
                EXPECT_EQ(corner[k][8 * upper + quad], expected[upper][k]) << target_name() << " " << quad;
    }
}

void check_all() {
    check_masks<16>(), check_masks<8>(), check_masks<4>();
    check_numbers_that_are_none();
    check_compressed_stores();
    check_table<16>(), check_table<8>();
    check_corners();
}

} // namespace
} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace relief {
namespace {

HWY_EXPORT(check_all);

TEST(Lanes, are_the_same_on_every_instruction_set) {
    test::check_on_every_target([] { HWY_DYNAMIC_DISPATCH(check_all)(); });
}

} // namespace
} // namespace relief

#endif
