// Settings that contradict each other are refused before anything is made.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "relief/error.h"
#include "relief/intersect.h"
#include "relief/render.h"

namespace relief {
namespace {

void expect_usage_error(const RenderSettings& settings) {
    try {
        render(Scene{}, settings);
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage) << error.what();
        EXPECT_FALSE(error.hint().empty());
    }
    const IntersectorSettings same{settings.surface, settings.device, settings.experiment};
    EXPECT_THROW(Intersector(Scene{}, same), Error);
}

TEST(Settings, of_one_engine_do_not_go_with_the_other) {
    RenderSettings settings;
    settings.device.index = 0;
    expect_usage_error(settings);
    settings = {};
    settings.experiment.bottom = BottomForm::fused;
    expect_usage_error(settings);
    settings = {};
    settings.device.engine = EngineKind::vulkan;
    settings.device.isa = Isa::scalar;
    expect_usage_error(settings);
    settings.device.isa = Isa::best;
    settings.device.index = -2;
    expect_usage_error(settings);
}

TEST(Settings, of_costs_are_refused_where_no_tree_is_built_by_them) {
    RenderSettings settings;
    settings.experiment.sah_costs = SahCosts{};
    expect_usage_error(settings);
    settings.experiment.traversal = TraversalKind::wide;
    expect_usage_error(settings);
    settings.experiment.structure = StructureKind::lbvh, settings.experiment.traversal = TraversalKind::stack;
    expect_usage_error(settings);
    settings.experiment.structure = StructureKind::bvh;
    for (const float cost : {0.0f, -1.0f, std::numeric_limits<float>::infinity(), std::nanf("")}) {
        settings.experiment.sah_costs = SahCosts{cost, 1};
        expect_usage_error(settings);
        settings.experiment.sah_costs = SahCosts{1, cost};
        expect_usage_error(settings);
    }
    settings.device.engine = EngineKind::vulkan, settings.experiment.sah_costs = SahCosts{};
    expect_usage_error(settings);
}

TEST(Settings, of_a_method_name_what_goes_with_it) {
    RenderSettings settings;
    settings.experiment.method = RenderMethod::fragment;
    expect_usage_error(settings);
    settings.experiment.method = RenderMethod::hybrid;
    expect_usage_error(settings);
    settings.device.engine = EngineKind::vulkan;
    settings.surface.lod = LodRule::ray;
    expect_usage_error(settings);
    settings.surface.lod = LodRule::field;
    settings.surface.leaf = LeafKind::box;
    expect_usage_error(settings);
    settings.surface.leaf = LeafKind::exact;
    settings.experiment.method = RenderMethod::fragment;
    settings.experiment.bottom = BottomForm::fused;
    expect_usage_error(settings);
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
