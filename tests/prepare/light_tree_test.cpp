// The tree over many lights: its shape, and that nothing below a node shines more than the node says.
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "formulas/constants.h"
#include "formulas/warp.h"
#include "prepare/light_sources.h"
#include "prepare/light_tree.h"
#include "prepare/prepared_scene.h"
#include "support/many_lights.h"

namespace relief {
namespace {

constexpr double kPi = std::numbers::pi;

class Numbers {
  public:
    explicit Numbers(uint32_t seed) : random_(seed) {}
    float next() { return unit_(random_); }
    Vec3f next_direction() {
        const float x = next();
        return normalize(scalar::square_to_sphere({x, next()}));
    }

  private:
    std::mt19937 random_;
    std::uniform_real_distribution<float> unit_{0, 1};
};

LightTables make_hall_tables(size_t light_count) {
    const auto prepared = prepare_scene(make_hall(light_count), {});
    return make_light_tables(*prepared, 0.5f, make_emitter_table(*prepared));
}

TEST(LightTree, is_there_for_many_lights_alone) {
    EXPECT_TRUE(make_hall_tables(29).nodes.empty()); // and the sky and two bodies
    const LightTables few = make_hall_tables(29), many = make_hall_tables(30);
    EXPECT_EQ(few.sources.size(), 31u);
    EXPECT_EQ(few.listed_count, 31u);
    EXPECT_EQ(many.nodes.size(), 2 * (30u + 2 * 54) - 1);
    EXPECT_EQ(many.sources.size(), 31u);
    EXPECT_EQ(many.listed_count, 1u) << "the sky";
}

TEST(LightTree, holds_every_light_once_in_depth_first_order) {
    const LightTables tables = make_hall_tables(500);
    std::vector<uint32_t> sources(tables.sources.size()), emitters(2 * 54);
    for (uint32_t k = 0; k < tables.nodes.size(); ++k) {
        const scalar::LightNodeData& node = tables.nodes[k];
        if (node.source == scalar::kNone) {
            const uint32_t second = tables.nodes[k + 1].end;
            ASSERT_LT(second, node.end);
            EXPECT_EQ(tables.nodes[second].end, node.end);
            EXPECT_EQ(tables.nodes[k + 1].flags | tables.nodes[second].flags, node.flags);
            const float power = tables.nodes[k + 1].power + tables.nodes[second].power;
            EXPECT_NEAR(power, node.power, 1e-5f * node.power);
            continue;
        }
        EXPECT_EQ(node.end, k + 1);
        if (node.source < scalar::kEmitterLeaf) {
            ++sources.at(node.source);
            continue;
        }
        ++emitters.at(node.source & ~scalar::kEmitterLeaf);
        EXPECT_EQ(tables.leaf_of_emitter.at(node.source & ~scalar::kEmitterLeaf), k);
    }
    EXPECT_EQ(tables.nodes.front().end, tables.nodes.size());
    EXPECT_EQ(sources.front(), 0u) << "the sky has no place";
    for (size_t k = 1; k < sources.size(); ++k) EXPECT_EQ(sources[k], 1u) << k;
    for (const uint32_t count : emitters) EXPECT_EQ(count, 1u);
}

/// Calls visit(node, light) for each light of the list and each node above it.
template <class Visit> void visit_pairs(const LightTables& tables, const Visit& visit) {
    for (const scalar::LightNodeData& node : tables.nodes) {
        const uint32_t first = uint32_t(&node - tables.nodes.data());
        for (uint32_t k = first; k < node.end; ++k)
            if (tables.nodes[k].source < scalar::kEmitterLeaf)
                visit(node, tables.sources[tables.nodes[k].source]);
    }
}

TEST(LightTree, is_never_dark_where_a_light_below_shines) {
    Numbers numbers(4);
    int dark = 0, lit = 0;
    visit_pairs(make_hall_tables(300), [&](const scalar::LightNodeData& node, const auto& source) {
        for (int k = 0; k < 8; ++k) {
            // Half of the places are so near that the light looks large.
            const float distance = k % 2 == 0 ? 20 * numbers.next() : 0.3f * numbers.next();
            const Vec3f at = source.center + numbers.next_direction() * distance;
            const Vec2f u{numbers.next(), numbers.next()};
            const scalar::LightDraw drawn = scalar::draw_listed_light(source, at, u);
            const float estimate = scalar::estimate_node(node, {at, numbers.next_direction(), 0});
            dark += estimate == 0;
            if (!(drawn.pdf > 0) || drawn.weight == Vec3f{}) continue;
            ++lit;
            ASSERT_GT(estimate, 0);
        }
    });
    EXPECT_GT(lit, 1000);
    EXPECT_GT(dark, 300) << "or spots and faces would not count";
}

TEST(LightTree, finds_all_lights_that_rays_meet) {
    Numbers numbers(5);
    int met = 0, passed = 0;
    visit_pairs(make_hall_tables(300), [&](const scalar::LightNodeData& node, const auto& source) {
        const Vec3f aside = numbers.next_direction() * (0.3f * numbers.next());
        const Vec3f origin = source.center + numbers.next_direction() * (0.01f + 20 * numbers.next());
        const Vec3f direction = normalize(source.center + aside - origin);
        const float distance = 20 * numbers.next();
        const bool is_met = !(scalar::meet_light(source, origin, direction, distance).radiance == Vec3f{});
        const bool may_be = scalar::may_meet(node, origin, direction, distance);
        met += is_met, passed += !may_be;
        ASSERT_TRUE(may_be || !is_met);
        ASSERT_TRUE((node.flags & scalar::kCanBeMet) != 0 || !is_met);
    });
    EXPECT_GT(met, 100);
    EXPECT_GT(passed, 300);
}

TEST(LightTree, joins_cones_to_one_about_both) {
    Numbers numbers(6);
    for (int k = 0; k < 3000; ++k) {
        const LightCone a{numbers.next_direction(), kPi * double(numbers.next() * numbers.next()), 0.3};
        LightCone b{numbers.next_direction(), kPi * double(numbers.next() * numbers.next()), 0.5};
        if (k % 10 == 0) b.axis = k % 20 == 0 ? a.axis : -a.axis;
        const LightCone joined = join_cones(a, b);
        EXPECT_EQ(joined.reach, 0.5);
        EXPECT_LE(joined.spread, kPi);
        EXPECT_NEAR(length(joined.axis), 1, 1e-5f);
        for (const LightCone& cone : {a, b}) {
            const double turn = std::atan2(double(length(cross(cone.axis, joined.axis))),
                                           double(dot(cone.axis, joined.axis)));
            EXPECT_TRUE(joined.spread > kPi - 1e-9 || turn + cone.spread <= joined.spread + 1e-5) << k;
        }
    }
}

TEST(LightTree, takes_lights_in_one_place_and_none) {
    EXPECT_TRUE(make_light_tree({}).empty());
    LightLeaf leaf;
    leaf.box.extend(Vec3f{1, 2, 3});
    leaf.power = 2;
    for (const size_t count : {1u, 2u, 77u}) {
        const auto nodes = make_light_tree(std::vector<LightLeaf>(count, leaf));
        ASSERT_EQ(nodes.size(), 2 * count - 1);
        EXPECT_EQ(nodes[0].radius, 0);
        EXPECT_NEAR(nodes[0].power, 2 * float(count), 1e-3f);
    }
}

} // namespace
} // namespace relief
