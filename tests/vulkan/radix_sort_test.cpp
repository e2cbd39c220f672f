// The device's sort against std::stable_sort.
#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "vulkan/gpu_fixture.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/radix_sort.h"

namespace relief::vulkan::tests {
namespace {

struct Pair {
    uint32_t key, value;
    bool operator==(const Pair&) const = default;
};

constexpr uint32_t kCounterWord = 3;

/// Pairs whose values are their places, so that a loss of order shows.
std::vector<Pair> make_pairs(uint32_t count, uint32_t key_bits) {
    std::mt19937 random(count + key_bits);
    std::vector<Pair> pairs(count);
    for (uint32_t i = 0; i < count; ++i)
        pairs[i] = {key_bits == 0 ? 0u : uint32_t(random()) >> (32 - key_bits), i};
    return pairs;
}

class RadixSorts : public GpuTest {
  protected:
    RadixSorts() : sort_(device()) {}

    std::vector<Pair> sort_on_device(const std::vector<Pair>& pairs, uint32_t count, uint64_t capacity,
                                     uint32_t key_bits) {
        const auto make = [&](const char* name, uint64_t bytes) {
            return Buffer(device(), {.name = name, .bytes = bytes});
        };
        Buffer unsorted = make("pairs", pairs.size() * sizeof(Pair));
        const Buffer sorted = make("sorted pairs", pairs.size() * sizeof(Pair));
        const Buffer histogram = make("histogram", sort_.histogram_words(capacity) * 4);
        Buffer counters = make("counters", 16);
        unsorted.upload(pairs);
        counters.upload(std::vector<uint32_t>{count}, kCounterWord * 4);
        BindingTable bindings(device());
        bindings.bind(scalar::kBindPairs, unsorted);
        bindings.bind(scalar::kBindSortedPairs, sorted);
        bindings.bind(scalar::kBindHistogram, histogram);
        bindings.bind(scalar::kBindCounters, counters);
        vulkan::Commands commands(device(), bindings);
        sort_.record(commands, capacity, key_bits, kCounterWord);
        commands.run();
        return unsorted.download<Pair>(pairs.size());
    }

    void expect_sorted(std::vector<Pair> pairs, uint32_t key_bits) {
        const uint32_t count = uint32_t(pairs.size());
        const std::vector<Pair> result = sort_on_device(pairs, count, count, key_bits);
        std::stable_sort(pairs.begin(), pairs.end(), [](Pair a, Pair b) { return a.key < b.key; });
        EXPECT_TRUE(result == pairs) << count << " pairs with keys of " << key_bits << " bits";
    }

    RadixSort sort_;
};

TEST_F(RadixSorts, every_small_count) {
    for (const uint32_t count : {0u, 1u, 2u, 3u, 255u, 256u, 2047u, 2048u, 2049u, 5000u})
        expect_sorted(make_pairs(count, 20), 20);
}

TEST_F(RadixSorts, keys_of_every_width) {
    for (uint32_t bits = 0; bits <= 32; ++bits) expect_sorted(make_pairs(4100, bits), bits);
}

TEST_F(RadixSorts, a_million_pairs) { expect_sorted(make_pairs(1'000'000, 22), 22); }

TEST_F(RadixSorts, equal_keys_keep_their_order) {
    std::vector<Pair> pairs = make_pairs(10'000, 13);
    for (Pair& pair : pairs) pair.key = 77;
    expect_sorted(pairs, 13);
}

TEST_F(RadixSorts, no_more_pairs_than_counted_nor_than_fit) {
    const std::vector<Pair> pairs = make_pairs(6000, 16);
    const auto by_key = [](Pair a, Pair b) { return a.key < b.key; };
    std::vector<Pair> expected = pairs;
    std::stable_sort(expected.begin(), expected.begin() + 2500, by_key);
    EXPECT_TRUE(sort_on_device(pairs, 2500, 6000, 16) == expected);
    EXPECT_TRUE(sort_on_device(pairs, 1'000'000, 2500, 16) == expected);
}

} // namespace
} // namespace relief::vulkan::tests
