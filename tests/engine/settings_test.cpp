// Settings that contradict each other are refused before anything is made.
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
    EXPECT_THROW(Intersector(Scene{}, settings), Error);
}

TEST(Settings, of_one_engine_do_not_go_with_the_other) {
    RenderSettings settings;
    settings.device = 0;
    expect_usage_error(settings);
    settings = {};
    settings.bottom = BottomForm::fused;
    expect_usage_error(settings);
    settings = {};
    settings.engine = EngineKind::vulkan;
    settings.isa = Isa::scalar;
    expect_usage_error(settings);
    settings.isa = Isa::best;
    settings.device = -2;
    expect_usage_error(settings);
}

} // namespace
} // namespace relief
