// The loop over the samples of a picture with motion blur: each block gets each sample at its own time,
// whenever noise asks for it.
#include <algorithm>

#include <gtest/gtest.h>

#include "api/moving_picture.h"
#include "engine/sample_plan.h"

namespace relief {
namespace {

/// Columns of blocks, all quiet at first but the sixth: it wakes the fifth late, when it flares up, and what
/// the fifth has slept through would wake the fourth.
float make_radiance(int x, int y, int sample) {
    const int column = x / SamplePlan::kBlockEdge;
    const bool is_odd = (x + y + sample) % 2 == 1;
    const bool flares = (x + 3 * y + sample) % 4 == 0;
    if (column == 5) return sample < 32 ? (is_odd ? 1.8f : 0.2f) : (flares ? 30.0f : 1.0f);
    if (column == 4 && sample >= 16 && sample < 32) return flares ? 200.0f : 1.0f;
    return is_odd ? 1.01f : 0.99f;
}

TEST(MovingPicture, adds_each_sample_of_a_block_at_its_own_time) {
    ImageSettings image;
    image.width = image.height = 96, image.spp = 160, image.noise = 0.2f;
    Film film(96, 96, {}, {}, ErrorEstimate::on);
    int now = -1, late = 0, reached = -1;
    ImageSettings part;
    const MovingStage stage{[&](int sample, const ImageSettings& up_to) {
                                now = sample, part = up_to;
                                late += sample < reached;
                                reached = std::max(reached, sample);
                            },
                            [&](Film& target, const RenderControl&) {
                                SamplePlan plan(target, part);
                                while (plan.start_pass())
                                    for (const SampleTask& task : plan.list_tasks(8)) {
                                        EXPECT_EQ(task.first, now);
                                        EXPECT_EQ(task.count, 1);
                                        for (int y = task.window.y0; y < task.window.y1; ++y)
                                            for (int x = task.window.x0; x < task.window.x1; ++x)
                                                for (int k = task.first; k < task.first + task.count; ++k) {
                                                    FilmSample sample;
                                                    const float value = make_radiance(x, y, k);
                                                    sample.radiance = {value, value, value};
                                                    target.add_sample(x, y, sample);
                                                }
                                    }
                                return !testing::Test::HasFailure();
                            }};
    EXPECT_TRUE(render_samples(film, image, {}, stage));
    EXPECT_GT(late, 0) << "no block came back, so that nothing was tested";
    EXPECT_LT(film.least_samples(), film.most_samples());
}

} // namespace
} // namespace relief
