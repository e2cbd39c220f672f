// Expectations of tests on the sides of refined quads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "surface/mesh/subdivision_mesh.h"

namespace relief::test {

/// Two quads share each side, except sharp sides, which may belong to one quad. A side that one quad has
/// whole and others in pieces would be used once. Returns the number of sides that belong to one quad.
inline size_t expect_shared_sides(const RefinedMesh& refined) {
    std::map<std::pair<uint32_t, uint32_t>, int> uses;
    std::vector<int> edge_uses(refined.is_sharp.size());
    const auto get_side = [&](uint32_t quad, size_t k) {
        const uint32_t a = refined.points[quad][k], b = refined.points[quad][(k + 1) % 4];
        return std::pair(std::min(a, b), std::max(a, b));
    };
    for (uint32_t quad = 0; quad < refined.quad_count(); ++quad)
        for (size_t k = 0; k < 4; ++k) {
            const auto side = get_side(quad, k);
            EXPECT_NE(side.first, side.second);
            ++uses[side], ++edge_uses[refined.edges[quad][k]];
            EXPECT_LE(refined.first_quads[refined.edges[quad][k]], quad);
        }
    size_t boundary_count = 0;
    for (uint32_t quad = 0; quad < refined.quad_count(); ++quad)
        for (size_t k = 0; k < 4; ++k) {
            const int count = uses[get_side(quad, k)];
            EXPECT_EQ(count, edge_uses[refined.edges[quad][k]]);
            EXPECT_TRUE(count == 2 || (count == 1 && refined.is_sharp[refined.edges[quad][k]]));
            boundary_count += count == 1;
        }
    return boundary_count;
}

} // namespace relief::test
