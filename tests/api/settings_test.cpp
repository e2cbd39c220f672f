// Settings that contradict each other are refused before anything is made.
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "relief/error.h"
#include "relief/intersect.h"
#include "relief/render.h"

namespace relief {
namespace {

/// Changes plain settings, expects a usage error whose message holds `part`, from every call that takes them.
void expect_refused(const std::function<void(RenderSettings&)>& change, const std::string& part) {
    RenderSettings settings;
    change(settings);
    const auto expect = [&](const std::function<void()>& call) {
        try {
            call();
            ADD_FAILURE() << "no error: " << part;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::usage) << error.what();
            EXPECT_NE(error.message().find(part), std::string::npos) << error.what();
            EXPECT_FALSE(error.hint().empty()) << error.what();
        }
    };
    expect([&] { render(Scene{}, settings); });
    expect([&] { Intersector(Scene{}, {settings.surface, settings.device, settings.experiment}); });
}

TEST(Settings, of_pictures_have_ranges) {
    for (const float limit : {-1.0f, INFINITY, NAN}) {
        RenderSettings settings;
        settings.image.clamp_indirect = limit;
        EXPECT_THROW(render(Scene{}, settings), Error) << limit;
        settings = {};
        settings.image.time_reserved_s = double(limit);
        EXPECT_THROW(render(Scene{}, settings), Error) << limit;
    }
}

void choose_vulkan(RenderSettings& s) { s.device.engine = EngineKind::vulkan; }

TEST(Settings, of_one_engine_do_not_go_with_the_other) {
    expect_refused([](auto& s) { s.device.index = 0; }, "go with the Vulkan engine");
    expect_refused([](auto& s) { s.experiment.bottom = BottomForm::fused; }, "go with the Vulkan engine");
    expect_refused([](auto& s) { choose_vulkan(s), s.device.isa = Isa::scalar; }, "goes with the CPU engine");
    expect_refused([](auto& s) { choose_vulkan(s), s.device.index = -2; }, "device is out of range");
}

TEST(Settings, of_costs_are_refused_where_no_tree_is_built_by_them) {
    const std::string where = "do not go with the linear BVH and the engine's default trees";
    expect_refused([](auto& s) { s.experiment.sah_costs = SahCosts{}; }, where);
    expect_refused(
        [](auto& s) { s.experiment.sah_costs = SahCosts{}, s.experiment.traversal = TraversalKind::wide; },
        where);
    expect_refused([](auto& s) { choose_vulkan(s), s.experiment.sah_costs = SahCosts{}; }, where);
    expect_refused(
        [](auto& s) {
            choose_vulkan(s), s.experiment.sah_costs = SahCosts{},
                              s.experiment.traversal = TraversalKind::wide;
        },
        where);
    expect_refused(
        [](auto& s) {
            s.experiment.sah_costs = SahCosts{};
            s.experiment.structure = StructureKind::lbvh, s.experiment.traversal = TraversalKind::stack;
        },
        where);
    for (const float cost : {0.0f, -1.0f, std::numeric_limits<float>::infinity(), std::nanf("")})
        for (const SahCosts& costs : {SahCosts{cost, 1}, SahCosts{1, cost}})
            expect_refused(
                [&](auto& s) {
                    s.experiment.sah_costs = costs, s.experiment.traversal = TraversalKind::stack;
                },
                "costs of the surface-area heuristic are out of range");
}

TEST(Settings, of_a_method_name_what_goes_with_it) {
    expect_refused([](auto& s) { s.experiment.method = RenderMethod::fragment; },
                   "goes with the Vulkan engine");
    expect_refused([](auto& s) { s.experiment.method = RenderMethod::hybrid; },
                   "goes with the Vulkan engine");
    expect_refused(
        [](auto& s) {
            choose_vulkan(s), s.experiment.method = RenderMethod::hybrid, s.surface.lod = LodRule::ray;
        },
        "one level");
    expect_refused(
        [](auto& s) {
            choose_vulkan(s), s.experiment.method = RenderMethod::hybrid, s.surface.leaf = LeafKind::box;
        },
        "not their boxes");
    expect_refused(
        [](auto& s) {
            choose_vulkan(s), s.experiment.method = RenderMethod::fragment,
                              s.experiment.bottom = BottomForm::fused;
        },
        "fused form");
}

TEST(Settings, of_the_hybrid_method_want_a_camera_without_a_lens) {
    RenderSettings settings;
    settings.device.engine = EngineKind::vulkan;
    settings.experiment.method = RenderMethod::hybrid;
    Scene scene;
    scene.camera.aperture_radius = 0.1f;
    try {
        render(scene, settings);
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage) << error.what();
        EXPECT_NE(error.hint().find("compute or fragment"), std::string::npos) << error.what();
    }
}

} // namespace
} // namespace relief
