// Numbers of UDIM tiles by their uvs, and back.
#include <limits>

#include <gtest/gtest.h>

#include "base/udim.h"

namespace relief {

TEST(Udim, numbers_columns_before_rows) {
    EXPECT_EQ(find_udim(0, 0), 1001);
    EXPECT_EQ(find_udim(0.999, 0.5), 1001);
    EXPECT_EQ(find_udim(1, 0), 1002);
    EXPECT_EQ(find_udim(9.999, 0), 1010);
    EXPECT_EQ(find_udim(0, 1), 1011);
    EXPECT_EQ(find_udim(8, 899.5), 9999);
}

TEST(Udim, has_none_outside_of_ten_columns_and_four_digits) {
    const double huge = std::numeric_limits<double>::infinity();
    for (const double outside :
         {-1e-9, -1.0, 10.0, 12.5, 1e18, huge, -huge, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_FALSE(find_udim(outside, 0)) << outside;
    for (const double outside :
         {-1e-9, -1.0, 900.0, 1e6, 1e18, huge, -huge, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_FALSE(find_udim(0, outside)) << outside;
    EXPECT_FALSE(find_udim(9, 899)) << "10000";
}

TEST(Udim, squares_have_the_numbers_that_lead_to_them) {
    for (int udim = kFirstUdim; udim <= kLastUdim; ++udim) {
        const UdimSquare square = find_udim_square(udim);
        ASSERT_EQ(find_udim(square.column + 0.5, square.row + 0.5), udim);
    }
}

} // namespace relief
