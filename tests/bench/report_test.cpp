#include "common/report.h"

#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "relief/error.h"

namespace relief::bench {
namespace {

TEST(Report, a_record_keeps_the_order_of_its_names) {
    Value value = {{"z", 1}, {"a", 2.5}};
    value["m"] = "text";
    value["z"] = true;
    EXPECT_EQ(write_json(value), R"({"z":true,"a":2.5,"m":"text"})");
    value.update({{"a", 3}, {"new", Value()}});
    EXPECT_EQ(write_json(value), R"({"z":true,"a":3,"m":"text","new":null})");
    EXPECT_EQ(write_json({{"a", Value::list({1, "b"})}}, 1), "{\n \"a\": [\n  1,\n  \"b\"\n ]\n}\n");
}

TEST(Report, what_is_written_is_read_again) {
    const std::string text = R"({"list":[1,-2,0.1,[],{}],"large":9007199254740993,"none":null,"no":false})";
    EXPECT_EQ(write_json(read_json(text)), text);
    EXPECT_THROW(read_json("{"), Error);
}

TEST(Report, numbers_become_each_other_and_nothing_else) {
    const Value value = {{"whole", uint64_t(1) << 53}, {"real", 2.75}, {"text", "7"}};
    EXPECT_EQ(value["whole"].get<double>(), 9007199254740992.0);
    EXPECT_EQ(value["real"].get<int>(), 2);
    EXPECT_GT(value["real"], 2.5);
    EXPECT_THROW(value["text"].get<int>(), Error);
    EXPECT_THROW(value["real"].get<std::string>(), Error);
    EXPECT_THROW(value["real"].get<bool>(), Error);
    EXPECT_THROW(value["missing"], Error);
    EXPECT_THROW(value[0], Error);
    EXPECT_EQ(value.text_or_empty("missing"), "");
}

TEST(Report, a_list_grows_from_nothing_and_is_no_record) {
    Value list;
    EXPECT_TRUE(list.empty());
    list.push_back(1);
    list.push_back({{"a", 1}});
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[1]["a"], 1);
    EXPECT_THROW(list["a"], Error);
    EXPECT_THROW(std::as_const(list)[2], Error);
}

TEST(Report, cells_are_quoted_where_they_must_be) {
    const Table table{{"a", "b"}, {{"x, y", 1}, {"say \"x\"", {}}, {"two\nlines", 0.25}, {"plain text", -3}}};
    EXPECT_EQ(write_csv(table), "a,b\n\"x, y\",1\n\"say \"\"x\"\"\",\n\"two\nlines\",0.25\nplain text,-3\n");
    EXPECT_THROW(write_csv({{"a"}, {{Value::list({1})}}}), Error);
}

} // namespace
} // namespace relief::bench
