#include "bench/paper2.h"

#include <string>

#include <gtest/gtest.h>

#include "bench/paper2_goals.h"
#include "bench/tables.h"
#include "common/report.h"
#include "lab/trees.h"
#include "relief/error.h"

namespace relief::bench {
namespace {

Value run_quick_paper2(Paper2Options options) {
    options.settings.device.threads = 1;
    return run_paper2(make_quick_options(options), [](const std::string&) {});
}

TEST(Paper2, measures_every_walk_of_every_tree_with_every_kind_of_rays) {
    Paper2Options options;
    options.scenes = {"hall"};
    const Value mesh = run_quick_paper2(options)["meshes"][0];
    EXPECT_EQ(mesh["builds"].size(), tree_kinds().size());
    size_t walks = 0, heap_walks = 0;
    for (const TreeKind kind : tree_kinds()) {
        const auto traversals = tree_traversals(kind);
        walks += traversals.size();
        if (traversals.front() == TraversalKind::trail) heap_walks += traversals.size();
    }
    // Four kinds of rays from the root, three of them from the last hit, too.
    EXPECT_EQ(mesh["casts"].size(), 4 * walks + 3 * heap_walks);
    EXPECT_EQ(mesh["combinations_that_agree"], mesh["casts"].size());
    EXPECT_LE(mesh["doubtful_hits"], mesh["casts"].size());
    for (const Value& cast : mesh["casts"]) {
        EXPECT_GT(cast["rays_per_s"], 0);
        EXPECT_GT(cast["bytes_a_ray"], 0);
    }
}

TEST(Paper2, writes_a_mesh_of_the_user_by_its_name) {
    Paper2Options options;
    options.scenes = {};
    options.meshes = {make_structure_scene("body", MeshDetail::reduced)};
    options.meshes[0].meshes[0].name = "a <mesh>, \"more\".obj";
    const Value result = run_quick_paper2(options);
    EXPECT_EQ(read_json(write_json(result, 1))["meshes"][0]["mesh"], "a <mesh>, \"more\".obj");
    const std::string csv = write_csv(make_paper2_table(result));
    EXPECT_NE(csv.find("\n\"a <mesh>, \"\"more\"\".obj\",build,heap,,,,bytes,bytes,"), std::string::npos)
        << csv;
}

TEST(Paper2, goals_are_ratios_of_what_was_measured) {
    const auto cast = [](const char* tree, const char* traversal, const char* rays, const char* start,
                         double s) {
        return Value{{"tree", tree},
                     {"traversal", traversal},
                     {"rays", rays},
                     {"start", start},
                     {"seconds", {{"median", s}}}};
    };
    Value mesh = {{"mesh", "m"}};
    mesh["builds"].push_back({{"tree", "heap"}, {"bytes", 100}});
    mesh["builds"].push_back({{"tree", "succinct lbvh"}, {"bytes", 30}});
    mesh["casts"].push_back(cast("heap", "trail", "shadow", "root", 2));
    mesh["casts"].push_back(cast("heap", "trail", "shadow", "last hit", 3));
    Value result;
    result["meshes"].push_back(mesh);
    const Value goals = make_paper2_goals(result);
    ASSERT_EQ(goals.size(), 2u);
    EXPECT_DOUBLE_EQ(goals[0]["reached"].get<double>(), 0.3);
    EXPECT_TRUE(goals[0]["met"].get<bool>());
    EXPECT_DOUBLE_EQ(goals[1]["reached"].get<double>(), 1.5);
    EXPECT_FALSE(goals[1]["met"].get<bool>());
}

TEST(Paper2, refuses_what_has_no_triangles_or_no_name) {
    Paper2Options options;
    options.scenes = {"bunny"};
    EXPECT_THROW(run_quick_paper2(options), Error);
    options.scenes = {};
    options.meshes = {make_structure_scene("body", MeshDetail::reduced)};
    options.meshes[0].meshes[0] = {};
    EXPECT_THROW(run_quick_paper2(options), Error);
}

} // namespace
} // namespace relief::bench
