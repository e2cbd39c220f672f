// Eight-wide BVH with 8-bit boxes, made from a binary one: what the CPU engine walks (after Ylitie, Karras, Laine 2017).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "structures/bvh.h"

namespace relief {

/// 96 bytes. Child boxes are origin + code * 2^exponent, so that the product is exact and every decoder agrees.
/// Codes are rounded outward and checked with the decoder itself. Unused slots have lower code 255 and upper code 0 in x.
struct WideNode {
    static constexpr uint32_t kLeafFlag = 0x80000000u;  ///< then bits 28..30: primitives - 1, bits 0..27: first
    static constexpr uint32_t kNoChild = 0xffffffffu;

    float origin[3];
    int8_t exponent[3];
    uint8_t child_count;
    uint8_t lower[3][8];
    uint8_t upper[3][8];
    uint32_t child[8];

    Box child_box(int k) const;
};
static_assert(sizeof(WideNode) == 96);

/// `leaf first` indexes primitive_ids, or is the primitive itself when primitive_ids is empty (every leaf holds one).
struct WideBvh {
    std::vector<WideNode> nodes;  ///< node 0 is the root; empty: no primitives
    std::vector<uint32_t> primitive_ids;
    Box bounds;

    size_t byte_count() const { return nodes.size() * sizeof(WideNode) + primitive_ids.size() * sizeof(uint32_t); }
};

/// Collapses the binary tree, always opening the child with the largest area (Wald, Benthin, Boulos 2008).
WideBvh make_wide_bvh(const Bvh& bvh);

} // namespace relief
