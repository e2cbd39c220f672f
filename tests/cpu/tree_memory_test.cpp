// Memory for patch trees: blocks keep what is written to them, and what is freed becomes whole again.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <thread>
#include <utility>
#include <vector>

#include "cpu/patch_trees/tree_memory.h"

namespace relief {

namespace {

constexpr size_t kBytes = size_t(1) << 20;

struct Block {
    uint8_t* memory;
    size_t bytes;
    uint8_t value;
};

bool is_whole(const Block& block) {
    return std::all_of(block.memory, block.memory + block.bytes, [&](uint8_t x) { return x == block.value; });
}

void free_one(cpu::TreeMemory& memory, void* block) { memory.free({&block, 1}); }

/// The most bytes that one block can have, to 64.
size_t find_largest(cpu::TreeMemory& memory) {
    size_t fits = 0;
    for (size_t step = kBytes; step >= 64; step /= 2) {
        void* block = memory.allocate(fits + step);
        if (!block) continue;
        memory.free({&block, 1});
        fits += step;
    }
    return fits;
}

/// Takes and frees blocks of the sizes of patch trees in random order; false if one was damaged.
bool keeps_blocks(cpu::TreeMemory& memory, uint32_t seed, int rounds) {
    constexpr size_t kSizes[] = {64, 320, 960, 1500, 4900, 16600, 57344};
    std::mt19937 random(seed);
    std::vector<Block> blocks;
    bool are_whole = true;
    for (int round = 0; round < rounds; ++round) {
        const size_t bytes = kSizes[random() % std::size(kSizes)];
        auto* taken = static_cast<uint8_t*>(memory.allocate(bytes));
        if (taken && uintptr_t(taken) % 64 == 0) {
            blocks.push_back({taken, bytes, uint8_t(random())});
            std::memset(taken, blocks.back().value, bytes);
        }
        // All that is there comes to be used: blocks are freed where there was no room, and now and then.
        for (uint32_t k = taken ? random() % 2 : 1 + random() % 8; k > 0 && !blocks.empty(); --k) {
            std::swap(blocks[random() % blocks.size()], blocks.back());
            are_whole = are_whole && is_whole(blocks.back());
            free_one(memory, blocks.back().memory);
            blocks.pop_back();
        }
    }
    for (const Block& block : blocks)
        are_whole = are_whole && is_whole(block), free_one(memory, block.memory);
    return are_whole;
}

TEST(TreeMemory, is_one_block_again_when_all_are_freed) {
    cpu::TreeMemory memory;
    ASSERT_TRUE(memory.add(kBytes));
    const size_t largest = find_largest(memory);
    EXPECT_GT(largest, kBytes - 256);
    EXPECT_TRUE(keeps_blocks(memory, 1, 20000));
    EXPECT_EQ(find_largest(memory), largest);
}

TEST(TreeMemory, gives_all_that_it_has_and_no_more) {
    cpu::TreeMemory memory;
    EXPECT_EQ(memory.allocate(64), nullptr);
    ASSERT_TRUE(memory.add(kBytes));
    size_t count = 0;
    while (memory.allocate(1024 - 64)) ++count; // with its head a block has 1024 bytes
    EXPECT_EQ(count, kBytes / 1024 - 1);        // a head ends what was added
    ASSERT_TRUE(memory.add(kBytes));
    EXPECT_NE(memory.allocate(kBytes / 2), nullptr);
}

TEST(TreeMemory, reuses_a_block_for_one_of_its_size) {
    cpu::TreeMemory memory;
    ASSERT_TRUE(memory.add(kBytes));
    std::vector<void*> blocks;
    while (void* block = memory.allocate(16600)) blocks.push_back(block);
    ASSERT_GT(blocks.size(), 60u);
    for (size_t k = 0; k < blocks.size(); k += 2) free_one(memory, blocks[k]);
    for (size_t k = 0; k < blocks.size(); k += 2) EXPECT_NE(memory.allocate(16600), nullptr);
    EXPECT_EQ(memory.allocate(16600), nullptr);
}

TEST(TreeMemory, tells_the_owners_of_neighbours_that_would_make_room) {
    cpu::TreeMemory memory;
    ASSERT_TRUE(memory.add(kBytes));
    std::vector<void*> blocks;
    while (void* block = memory.allocate(1024 - 64)) {
        if (blocks.size() != 5) memory.set_owner(block, uint32_t(blocks.size()));
        blocks.push_back(block);
    }
    std::vector<uint32_t> owners;
    ASSERT_TRUE(memory.find_owners(blocks[10], 4000, owners));
    EXPECT_EQ(owners, (std::vector<uint32_t>{10, 11, 12, 13}));
    owners.clear();
    ASSERT_TRUE(memory.find_owners(blocks[3], 4000, owners));
    EXPECT_EQ(owners, (std::vector<uint32_t>{6, 7, 8, 9})) << "the fifth has no owner";
    owners.clear();
    EXPECT_FALSE(memory.find_owners(blocks[blocks.size() - 3], 4000, owners)) << "the end is near";
    EXPECT_TRUE(owners.empty());
    for (size_t k = 6; k < 10; ++k) free_one(memory, blocks[k]);
    EXPECT_NE(memory.allocate(4000), nullptr);
}

TEST(TreeMemory, serves_many_threads) {
    cpu::TreeMemory memory;
    ASSERT_TRUE(memory.add(kBytes));
    const size_t largest = find_largest(memory);
    bool are_whole[4] = {};
    std::vector<std::thread> threads;
    for (uint32_t k = 0; k < 4; ++k)
        threads.emplace_back([&, k] { are_whole[k] = keeps_blocks(memory, k, 5000); });
    for (std::thread& thread : threads) thread.join();
    for (const bool whole : are_whole) EXPECT_TRUE(whole);
    EXPECT_EQ(find_largest(memory), largest);
}

} // namespace

} // namespace relief
