// Where paths end: by chance, and behind their last vertex.
#include <gtest/gtest.h>

#include "formulas/path.h"

namespace relief {
namespace {

TEST(PathEnds, roulette_spares_the_first_bounce_and_what_carries_much) {
    EXPECT_EQ(scalar::survival_probability(0, {0.01f, 0.01f, 0.01f}), 1);
    EXPECT_EQ(scalar::survival_probability(1, {0.1f, 0.25f, 0.1f}), 1);
    EXPECT_FLOAT_EQ(scalar::survival_probability(1, {0.1f, 0.05f, 0.1f}), 0.4f);
}

TEST(PathEnds, one_ray_looks_for_light_behind_the_last_vertex_of_paths_that_bounce) {
    EXPECT_EQ(scalar::find_last_depth(0), 0u);
    EXPECT_EQ(scalar::find_last_depth(1), 2u);
    EXPECT_EQ(scalar::find_last_depth(4), 5u);
}

} // namespace
} // namespace relief
