// Hits on objects that lie far from the origin, beside exact arithmetic.
#include "support/far_objects.h"

namespace relief {
namespace {

class FarObjects : public testing::TestWithParam<test::FarCase> {};

TEST_P(FarObjects, are_hit_where_they_are) {
    IntersectorSettings settings;
    test::expect_right_hits(GetParam(), settings, 160);
}

INSTANTIATE_TEST_SUITE_P(Cases, FarObjects, testing::ValuesIn(test::list_far_cases()),
                         [](const auto& info) { return info.param.name; });

TEST(FarPictures, are_those_near_the_origin) { test::expect_picture_is_moved({}); }

} // namespace
} // namespace relief
