#include "base/content_hash.h"

#include <gtest/gtest.h>

namespace relief {

TEST(ContentHash, is_xxh3_of_parts_in_their_order) {
    const auto hash = [](auto... parts) {
        ContentHash sum;
        (sum.add(parts), ...);
        return sum.value();
    };
    EXPECT_EQ(hash(std::string_view()), 0x2d06800538d394c2u); // given by its author
    EXPECT_EQ(hash("a", "bc"), hash("a", "bc"));
    EXPECT_NE(hash("a", "bc"), hash("ab", "c"));
    EXPECT_NE(hash("a", "bc"), hash("bc", "a"));
    EXPECT_NE(hash("a", ""), hash("a"));
    ContentHash rest(hash("a"));
    rest.add("bc");
    EXPECT_EQ(rest.value(), hash("a", "bc"));
}

} // namespace relief
