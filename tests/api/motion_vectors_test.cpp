// Where the middles of pixels are at another time.
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "api/make_engine.h"
#include "api/motion_vectors.h"
#include "support/session_scenes.h"

namespace relief {
namespace {

TEST(MotionVectors, of_the_same_time_are_the_middles_of_all_pixels_however_rows_are_grouped) {
    RenderSettings settings = test::make_session_settings();
    settings.image.width = 40, settings.image.height = 30;
    const auto scene = prepare_scene(test::make_rough_torus(), settings);
    const std::unique_ptr<Engine> engine = make_engine(scene, settings);
    const Window window{3, 2, 37, 29};
    std::vector<Vec2f> first;
    for (const size_t rays : {MotionVectors::kRaysOfACall, size_t(1), size_t(100)}) {
        const std::vector<Vec2f> places = MotionVectors(*engine, *scene, window, rays).find_places(*scene);
        ASSERT_EQ(places.size(), size_t(34 * 27));
        size_t k = 0;
        for (int y = window.y0; y < window.y1; ++y)
            for (int x = window.x0; x < window.x1; ++x, ++k) {
                EXPECT_NEAR(places[k].x, float(x) + 0.5f, 1e-2f) << rays;
                EXPECT_NEAR(places[k].y, float(y) + 0.5f, 1e-2f) << rays;
            }
        if (first.empty()) first = places;
        EXPECT_EQ(places, first) << rays << " rays a call";
    }
}

} // namespace
} // namespace relief
