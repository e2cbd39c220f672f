#include "bench/bar_chart.h"

#include <gtest/gtest.h>

#include "support/xml.h"

namespace relief::bench {
namespace {

size_t count(const std::string& text, const std::string& part) {
    size_t found = 0;
    for (size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++found;
    return found;
}

Chart make_chart() {
    Chart chart;
    chart.title = "Times <of> this & that";
    chart.axis = "milliseconds";
    chart.series = {"build", "cast"};
    chart.panels = {{"first", "more", {{"a", {1, 2}, "", 2.5, 3.5}, {"b", {0, 0}, "refused", 0, 0}}},
                    {"second", "", {{"c", {3000, 0}, "", 0, 0}}}};
    chart.notes = {"a note"};
    return chart;
}

TEST(BarChart, is_well_formed_and_says_all) {
    const std::string svg = make_bar_chart(make_chart());
    EXPECT_EQ(test::find_xml_fault(svg), "");
    for (const char* text : {"Times &lt;of&gt; this &amp; that", "milliseconds", "build", "cast", "first",
                             "second", "refused", "a note", ">3 ms<", ">3 s<"})
        EXPECT_NE(svg.find(text), svg.npos) << text;
    // Background, two squares of the legend, three segments that are not 0.
    EXPECT_EQ(count(svg, "<rect"), 6u);
}

TEST(BarChart, on_a_logarithmic_scale_is_shared_by_all_panels) {
    Chart chart = make_chart();
    chart.unit = Unit::bytes, chart.scale = Scale::logarithmic;
    chart.panels = {{"x", "", {{"a", {0, 1e3}, "", 0, 0}}}, {"y", "", {{"b", {5e9, 0}, "", 0, 0}}}};
    const std::string svg = make_bar_chart(chart);
    EXPECT_EQ(test::find_xml_fault(svg), "");
    EXPECT_EQ(count(svg, ">10 GB<"), 2u);
    EXPECT_EQ(count(svg, ">5 GB<"), 1u);
}

TEST(BarChart, without_panels_or_values_is_still_a_picture) {
    Chart chart = make_chart();
    chart.panels.clear();
    EXPECT_EQ(test::find_xml_fault(make_bar_chart(chart)), "");
    chart.panels = {{"empty", "", {}}, {"nothing", "", {{"a", {0, 0}, "", 0, 0}}}};
    EXPECT_EQ(test::find_xml_fault(make_bar_chart(chart)), "");
    chart.scale = Scale::logarithmic;
    EXPECT_EQ(test::find_xml_fault(make_bar_chart(chart)), "");
}

TEST(BarChart, writes_values_with_a_fitting_unit) {
    EXPECT_EQ(format_value(Unit::milliseconds, 0), "0");
    EXPECT_EQ(format_value(Unit::milliseconds, 0.25), "0.25 ms");
    EXPECT_EQ(format_value(Unit::milliseconds, 0.025), "25 us");
    EXPECT_EQ(format_value(Unit::milliseconds, 999.6), "1000 ms");
    EXPECT_EQ(format_value(Unit::milliseconds, 1234), "1.23 s");
    EXPECT_EQ(format_value(Unit::bytes, 52e9), "52 GB");
    EXPECT_EQ(format_value(Unit::bytes, 380e6), "380 MB");
    EXPECT_EQ(format_value(Unit::bytes, 12), "12 B");
}

} // namespace
} // namespace relief::bench
