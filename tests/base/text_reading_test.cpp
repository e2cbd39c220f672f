// What all readers of text accept.
#include <gtest/gtest.h>

#include <sstream>
#include <vector>

#include "base/text_reading.h"

namespace relief {
namespace {

std::vector<std::string> read_lines(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; read_line(stream, line);) lines.push_back(line);
    return lines;
}

TEST(TextReading, lines_end_with_any_kind_of_end) {
    const std::vector<std::string> wanted = {"a", "", "bc", "d"};
    for (const std::string text : {"a\n\nbc\nd", "a\r\rbc\rd", "a\r\n\r\nbc\r\nd", "a\n\r\nbc\rd\n"}) {
        EXPECT_EQ(read_lines(text), wanted);
        std::string_view left = text;
        for (const std::string& line : wanted) EXPECT_EQ(take_line(left), line);
        EXPECT_TRUE(left.empty());
    }
    EXPECT_TRUE(read_lines("").empty());
}

TEST(TextReading, marks_of_utf8_are_skipped_and_wider_texts_told_apart) {
    EXPECT_EQ(skip_byte_order_mark("\xef\xbb\xbfv 1"), "v 1");
    EXPECT_EQ(skip_byte_order_mark("v 1"), "v 1");
    EXPECT_EQ(read_lines("\xef\xbb\xbf{}\n[]"), (std::vector<std::string>{"{}", "[]"}));
    EXPECT_TRUE(is_wide_text(std::string("\xff\xfev\0", 4)));
    EXPECT_TRUE(is_wide_text(std::string("\xfe\xff\0v", 4)));
    EXPECT_FALSE(is_wide_text("\xef\xbb\xbfv"));
}

TEST(TextReading, places_are_counted_by_any_kind_of_end) {
    for (const std::string text : {"a\nbc\nd", "a\rbc\rd", "a\r\nbc\r\nd"}) {
        const TextPlace place = find_place(text, text.find('c'));
        EXPECT_EQ(place.line, 2u);
        EXPECT_EQ(place.column, 2u);
        EXPECT_EQ(find_place(text, text.find('d')).line, 3u);
    }
}

TEST(TextReading, deep_nesting_is_found_outside_of_texts_and_comments) {
    const std::string most(kMostNesting, '['), more(kMostNesting + 1, '{');
    EXPECT_FALSE(find_deep_nesting(most));
    EXPECT_EQ(find_deep_nesting(" " + more), std::optional(kMostNesting + 1));
    EXPECT_FALSE(find_deep_nesting("\"\\\"" + more + "\""));
    EXPECT_FALSE(find_deep_nesting("//" + more + "\n[]"));
    EXPECT_FALSE(find_deep_nesting("/*" + more + "*/[]"));
    EXPECT_TRUE(find_deep_nesting("/**/" + more));
    EXPECT_FALSE(find_deep_nesting("/*" + more));
    EXPECT_FALSE(find_deep_nesting("\"" + more + "\\"));
    std::string flat = "[";
    for (size_t k = 0; k < 2 * kMostNesting; ++k) flat += "[],";
    EXPECT_FALSE(find_deep_nesting(flat + "[]]"));
    EXPECT_TRUE(find_deep_nesting(std::string(1000000, '[')));
}

} // namespace
} // namespace relief
