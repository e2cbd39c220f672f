// What a hundred maps in all orders of their channels look like: no right order is doubted, and what is clear
// is caught.
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "analysis/map_convention.h"
#include "analysis/map_on_mesh.h"
#include "inspect/findings.h"
#include "support/bodies.h"
#include "support/map_set.h"
#include "support/sculpt.h"

namespace relief::test {
namespace {

constexpr uint32_t kSetSize = 48;

MapConvention guess(const std::shared_ptr<const Texture>& texture) {
    const Displacement map = make_map(texture);
    return guess_convention(map, measure_map(map.tiles, Vec3f{}), nullptr);
}

/// Orders that a convention does not doubt.
size_t count_agreeing(const MapConvention& convention) {
    size_t count = 0;
    for (const AxisMap& axes : get_all_axis_maps()) {
        Displacement map;
        map.axes = axes;
        count += agrees_on_axes(convention, map);
    }
    return count;
}

/// Says of how many maps of a kind the normal and the hand are clear.
struct Clear {
    size_t normal = 0, hand = 0, all = 0;
};

TEST(MapSet, no_right_order_of_a_hundred_maps_is_doubted) {
    std::map<std::string, Clear> kinds;
    const std::vector<FormulaMap> maps = make_map_set();
    ASSERT_EQ(maps.size(), 100u);
    for (size_t k = 0; k < maps.size(); ++k) {
        Clear& clear = kinds[maps[k].kind];
        const std::shared_ptr<Texture> texture = make_formula_texture(maps[k], kSetSize);
        for (const AxisMap& axes : get_all_axis_maps()) {
            const MapConvention convention = guess(permute_channels(*texture, axes));
            Displacement map;
            map.axes = axes;
            const std::string place = maps[k].kind + " " + std::to_string(k) + ": " + convention.axes.reason;
            EXPECT_FALSE(convention.is_order_clear) << place;
            if (convention.axes.is_clear) {
                EXPECT_TRUE(agrees_on_axes(convention, map)) << place;
                EXPECT_FALSE(contradicts_axes(convention, map)) << place;
            }
            const bool is_hand_clear = convention.axes.is_clear && convention.is_hand_clear;
            clear.normal += convention.axes.is_clear, clear.hand += is_hand_clear, ++clear.all;
            // 16 orders have the channel along the normal, 4 of these its sign and the hand.
            if (convention.axes.is_clear)
                EXPECT_EQ(count_agreeing(convention), is_hand_clear ? 4u : 16u) << place;
        }
    }
    for (const auto& [kind, clear] : kinds)
        std::printf("%-9s normal clear %5.1f %%, hand clear %5.1f %%\n", kind.c_str(),
                    100.0 * double(clear.normal) / double(clear.all),
                    100.0 * double(clear.hand) / double(clear.all));
    for (const char* kind : {"mushroom", "ear"}) EXPECT_EQ(kinds[kind].hand, kinds[kind].all) << kind;
    for (const char* kind : {"mushroom", "ear", "twist", "spiral", "vortex"})
        EXPECT_EQ(kinds[kind].normal, kinds[kind].all) << kind;
    EXPECT_LT(kinds["hook"].normal, kinds["hook"].all) << "some lean further than they rise";
}

TEST(MapSet, the_order_of_t_and_b_is_never_written_down) {
    const FormulaMap ear = make_map_set()[80];
    ASSERT_EQ(ear.kind, "ear");
    const auto doubt = [&](const AxisMap& axes) {
        Displacement map = make_map(permute_channels(*make_formula_texture(ear, kSetSize), axes));
        map.assumed.axes = true;
        return find_text(
            {{}, find_doubtful_assumptions(make_body_scene(make_sculpt_plane(), std::move(map)))}, "I-AXES");
    };
    EXPECT_EQ(doubt({}), "");
    EXPECT_EQ(doubt({{1, 0, 2}, {-1, 1, 1}}), "") << "a quarter turn";
    const std::string other = doubt({{0, 2, 1}, {1, 1, 1}}), exchanged = doubt({{1, 0, 2}, {1, 1, 1}});
    EXPECT_HAS_PART(other, "G is along the normal");
    EXPECT_HAS_PART(other, "presets mudbox, maya, cycles, arnold, moonray write t,n,b");
    EXPECT_HAS_PART(exchanged, "look exchanged, or one of them negated");
    EXPECT_HAS_PART(doubt({{0, 1, 2}, {1, -1, 1}}), "look exchanged, or one of them negated");
    EXPECT_HAS_PART(doubt({{0, 1, 2}, {1, 1, -1}}), "backwards");
    for (const std::string& text : {other, exchanged})
        EXPECT_EQ(text.find("write displacement"), std::string::npos) << text;
}

} // namespace
} // namespace relief::test
