// Relief against Embree: agreement before times, goals, files.
#ifdef RELIEF_EMBREE

#include "bench/peers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "bench/peer_agreement.h"
#include "bench/peers_goals.h"
#include "lab/scenes/peer_scenes.h"
#include "relief/error.h"
#include "relief/samples.h"

namespace relief::bench {
namespace {

RenderSettings make_settings(int level) {
    RenderSettings settings;
    settings.image.width = 160, settings.image.height = 90;
    settings.surface.level = level;
    settings.device.threads = 2;
    return settings;
}

/// Made once: its map takes a while.
const Scene& make_rock() {
    static const Scene kRock = make_peer_scene("rock", 1, PeerWorld::constant);
    return kRock;
}

TEST(Peers, all_ways_of_embree_meet_the_surface_that_relief_traces) {
    const Scene pumpkin = make_sample_scene("pumpkin", Instancing::none);
    for (const int level : {3, kAutoLevel})
        for (const Scene* scene : {&make_rock(), &pumpkin}) {
            const TracerProbe probe(*scene, make_settings(level));
            const std::vector<PeerRays> sets = make_peer_rays(probe, scene->camera);
            ASSERT_EQ(sets.size(), 4u + kPeerBounces);
            for (const EmbreeWay way : kEmbreeWays) {
                const EmbreeScene embree(probe, way, 2);
                EXPECT_GT(embree.byte_count(), 0u);
                for (const PeerRays& set : sets) {
                    const Agreement agreement = compare_with_embree(probe, embree, way, set);
                    EXPECT_GT(agreement.hits, 0u) << set.name;
                    EXPECT_NO_THROW(require_agreement(way_name(way), agreement)) << set.name;
                    EXPECT_LE(agreement.missed + agreement.extra, 2u) << set.name << " " << way_name(way);
                }
            }
        }
}

TEST(Peers, packets_of_embree_find_what_single_rays_find) {
    const Scene scene = make_rock();
    const TracerProbe probe(scene, make_settings(3));
    const EmbreeScene embree(probe, EmbreeWay::triangles, 2);
    std::vector<PeerRays> sets = make_peer_rays(probe, scene.camera);
    for (const char* name : {"primary", "sun"}) {
        PeerRays set = find_rays(sets, name);
        set.rays.pop_back(); // the last packet is not full
        const EmbreeRun single = embree.trace(set.rays, {set.kind, 1, false, 1});
        for (const int width : {8, 16}) {
            const EmbreeRun packets = embree.trace(set.rays, {set.kind, width, true, 2});
            const uint64_t more = std::max(packets.hit_count, single.hit_count);
            EXPECT_LE(more - std::min(packets.hit_count, single.hit_count), 2u) << name << width;
        }
    }
}

TEST(Peers, a_surface_of_another_size_is_found_out) {
    Scene scaled = make_rock();
    for (Vec3f& row : scaled.objects[0].world_from_object.rows)
        row = {row.x * 1.01f, row.y * 1.01f, row.z * 1.01f};
    const TracerProbe probe(make_rock(), make_settings(3)), other(scaled, make_settings(3));
    const std::vector<PeerRays> sets = make_peer_rays(probe, scaled.camera);
    for (const EmbreeWay way : kEmbreeWays) {
        const EmbreeScene embree(other, way, 1);
        for (const char* name : {"primary", "occlusion"}) {
            const Agreement agreement = compare_with_embree(probe, embree, way, find_rays(sets, name));
            try {
                require_agreement("scaled", agreement);
                FAIL() << "no error: " << name;
            } catch (const Error& error) {
                EXPECT_EQ(error.kind(), ErrorKind::failed);
                EXPECT_NE(std::string(error.what()).find("no times are reported"), std::string::npos);
            }
        }
    }
    EXPECT_THROW(require_agreement("scaled", compare_with_tessellated(probe, other, sets.front())), Error);
}

TEST(Peers, tells_unknown_scenes) {
    PeersOptions options;
    options.scenes = {"pebble"};
    EXPECT_THROW(run_peers(options, [](const std::string&) {}), Error);
}

TEST(Peers, leaves_out_triangles_above_the_limit) {
    PeersOptions options;
    options.scenes = {"rock"}, options.levels = {2};
    options.tessellated_limit_bytes = 0;
    const Value result = run_peers(make_quick_options(options), [](const std::string&) {});
    const Value& scene = result["scenes"][0];
    EXPECT_TRUE(scene.contains("triangles_left_out"));
    EXPECT_FALSE(scene["cold"].contains("triangles"));
    EXPECT_TRUE(scene["cold"].contains("grid"));
}

Value make_single_summary(double value) {
    return {{"median", value}, {"lowest", value}, {"highest", value}, {"runs", 1}};
}

Value make_way(const char* program, const char* way, const char* call, int threads, const char* isa,
               double seconds) {
    Value result = {
        {"program", program}, {"way", way}, {"threads", threads}, {"seconds", make_single_summary(seconds)}};
    if (*call) result["call"] = call;
    if (*isa) result["isa"] = isa;
    return result;
}

/// What was reached, by the name of the goal.
double find_reached_by_name(const Value& goals, const std::string& name) {
    for (const Value& goal : goals)
        if (goal["what"] == name) return goal["reached"].get<double>();
    return -1;
}

TEST(Peers, computes_goals_from_measures) {
    Value scene = {{"scene", "rock"}, {"level", "5"}, {"isa", "avx512"}, {"bounces", Value::list()}};
    scene["memory"] = {{"bytes_a_patch", 128.0}, {"bytes_a_micro_quad", 7.0}};
    scene["agreement"] = Value::list({{{"against", "Embree triangles"},
                                       {"missed", 1},
                                       {"extra", 0},
                                       {"depth", 2},
                                       {"at_edges", 2},
                                       {"grazing", 1}}});
    for (const auto& [way, seconds] : {std::pair("relief", 0.1), {"triangles", 9.0}, {"grid", 1.5}})
        scene["cold"][way] = {{"first_primary_s", make_single_summary(seconds)},
                              {"first_occlusion_s", make_single_summary(2 * seconds)},
                              {"first_diffuse_s", make_single_summary(2 * seconds)}};
    scene["casts"] = Value::list({{{"rays", "occlusion"}, {"kind", "any"}, {"coherent", false}}});
    scene["casts"][0]["ways"] = Value::list({make_way("relief", "rays", "", 2, "avx512", 0.5),
                                             make_way("relief", "rays", "", 2, "avx2", 0.625),
                                             make_way("relief", "rays", "", 1, "avx512", 1.0),
                                             make_way("embree", "triangles", "rtcOccluded1", 2, "", 1.0),
                                             make_way("embree", "triangles", "rtcOccluded1", 1, "", 7.0)});
    for (int depth : {1, 5}) scene["bounces"].push_back({{"depth", depth}, {"seconds_a_ray", 1e-6 * depth}});
    const Value goals = make_peers_goals({{"settings", {{"threads", 2}}}, {"scenes", Value::list({scene})}});
    EXPECT_DOUBLE_EQ(find_reached_by_name(goals, "first image from cold, primary, best of Embree"), 15);
    EXPECT_DOUBLE_EQ(find_reached_by_name(goals, "first image from cold, primary, Embree's triangles"), 90);
    EXPECT_DOUBLE_EQ(find_reached_by_name(goals, "occlusion, rtcOccluded1 on triangles"), 2);
    EXPECT_DOUBLE_EQ(find_reached_by_name(goals, "occlusion, rtcOccluded1 on grids"), -1);
    EXPECT_DOUBLE_EQ(find_reached_by_name(goals, "threads, occlusion"), 2);
    EXPECT_DOUBLE_EQ(find_reached_by_name(goals, "avx2 of avx512, occlusion"), 0.8);
    EXPECT_DOUBLE_EQ(find_reached_by_name(goals, "hits that differ beyond rounding"), 0);
    EXPECT_DOUBLE_EQ(find_reached_by_name(goals, "bounce 5 against bounce 1, time a ray"), 5);
    const std::string table = make_goal_table(goals);
    EXPECT_NE(table.find("| what | goal | rock, 5 |\n"), std::string::npos);
    EXPECT_NE(table.find("| bytes_a_patch | at most 64 bytes | **128** (0.5) |\n"), std::string::npos);
    EXPECT_NE(table.find("| bytes_a_micro_quad | at most 14 bytes | 7 |\n"), std::string::npos);
    for (const Value& goal : goals) {
        const double reached = goal["reached"].get<double>(), bound = goal["goal"].get<double>();
        EXPECT_EQ(goal["met"].get<bool>(), goal["bound"] == "at least" ? reached >= bound : reached <= bound)
            << goal["name"].get<std::string>();
        EXPECT_EQ(goal["met"].get<bool>(), goal["ratio"].get<double>() >= 1)
            << goal["name"].get<std::string>();
    }
}

} // namespace
} // namespace relief::bench

#endif
