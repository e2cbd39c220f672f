#include "image/cryptomatte.h"

#include <array>
#include <bit>
#include <cmath>

#include <gtest/gtest.h>

namespace relief {
namespace {

TEST(Cryptomatte, hashes_names_as_the_specification) {
    EXPECT_EQ(hash_name("torus"), 4053562365u);
    EXPECT_EQ(hash_name("\xd1\x80\xd0\xb0\xd0\xb2\xd0\xbd\xd0\xb8\xd0\xbd\xd0\xb0"), 2518896926u);
    EXPECT_EQ(hash_name("bunny"), 0x13851a76u);
    EXPECT_EQ(hash_name("default"), 0x42c9679fu);
    EXPECT_EQ(hash_name("bunny_porcelain_mat"), 0xb24b26d4u);
    EXPECT_FLOAT_EQ(std::bit_cast<float>(make_matte_id("torus")), -1.54943624832e+30f);
}

/// As the Python package mmh3 5 gives them: every length of the tail, and bytes above 127.
TEST(Cryptomatte, hashes_tails_of_every_length) {
    EXPECT_EQ(hash_name(""), 0u);
    EXPECT_EQ(hash_name("a"), 0x3c2569b2u);
    EXPECT_EQ(hash_name("ab"), 0x9bbfd75fu);
    EXPECT_EQ(hash_name("abc"), 0xb3dd93fau);
    EXPECT_EQ(hash_name("hello"), 0x248bfa47u);
    EXPECT_EQ(hash_name(std::string_view("\0", 1)), 0x514e28b7u);
    EXPECT_EQ(hash_name("\xc3\xbf"), 0xb189590eu);
}

TEST(Cryptomatte, makes_ids_that_are_normal_numbers) {
    EXPECT_EQ(hash_name("object 259"), 0x0069b367u);
    EXPECT_EQ(make_matte_id("object 259"), 0x00e9b367u) << "subnormal otherwise";
    EXPECT_EQ(make_matte_id("object 1008"), 0x80e27585u);
    EXPECT_EQ(hash_name("object 858"), 0xff868043u);
    EXPECT_EQ(make_matte_id("object 858"), 0xff068043u) << "NaN otherwise";
    EXPECT_EQ(make_matte_id(""), 0x00800000u) << "0 stands for nothing";
    for (int k = 0; k < 5000; ++k)
        EXPECT_TRUE(std::isnormal(std::bit_cast<float>(make_matte_id("object " + std::to_string(k)))));
}

TEST(Cryptomatte, names_two_ranks_a_layer_in_lower_case) {
    const std::vector<std::string> names = name_matte_channels("CryptoObject");
    ASSERT_EQ(names.size(), 2 * kMatteRanks);
    EXPECT_EQ(names.front(), "CryptoObject00.r");
    EXPECT_EQ(names[5], "CryptoObject01.g");
    EXPECT_EQ(names.back(), "CryptoObject02.a");
}

TEST(Cryptomatte, writes_the_entries_of_a_header) {
    std::map<std::string, std::string> entries;
    add_matte_entries("CryptoObject", {{"bunny", make_matte_id("bunny")}, {"a\"\\\n", 1}}, entries);
    EXPECT_EQ(entries.size(), 4u);
    EXPECT_EQ(entries["cryptomatte/3ae39a5/name"], "CryptoObject");
    EXPECT_EQ(entries["cryptomatte/3ae39a5/hash"], "MurmurHash3_32");
    EXPECT_EQ(entries["cryptomatte/3ae39a5/conversion"], "uint32_to_float32");
    EXPECT_EQ(entries["cryptomatte/3ae39a5/manifest"],
              "{\"a\\\"\\\\\\u000a\":\"00000001\",\"bunny\":\"13851a76\"}");
}

TEST(Cryptomatte, ranks_by_coverage_then_by_id) {
    std::array<MatteShare, 8> shares{{{9, 2}, {5, 7}, {0, 0}, {3, 2}, {8, 1}, {7, 1}, {6, 1}, {4, 1}}};
    std::array<float, 2 * kMatteRanks> ranks;
    write_matte_ranks(shares, 16, ranks.data());
    const std::array<uint32_t, kMatteRanks> ids{5, 3, 9, 4, 6, 7};
    const std::array<float, kMatteRanks> coverages{7.0f / 16, 2.0f / 16, 2.0f / 16,
                                                   1.0f / 16, 1.0f / 16, 1.0f / 16};
    for (size_t k = 0; k < kMatteRanks; ++k) {
        EXPECT_EQ(std::bit_cast<uint32_t>(ranks[2 * k]), ids[k]) << k;
        EXPECT_EQ(ranks[2 * k + 1], coverages[k]) << k;
    }
    std::array<MatteShare, 2> few{{{0, 0}, {5, 1}}};
    write_matte_ranks(few, 4, ranks.data());
    EXPECT_EQ(std::bit_cast<uint32_t>(ranks[0]), 5u);
    EXPECT_EQ(ranks[1], 0.25f);
    for (size_t k = 2; k < ranks.size(); ++k) EXPECT_EQ(ranks[k], 0) << k;
}

} // namespace
} // namespace relief
