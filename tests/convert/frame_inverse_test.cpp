// The way back through frames, sound or nearly collapsed.
#include <random>

#include <gtest/gtest.h>

#include "convert/frame_inverse.h"
#include "math/vec.h"

namespace relief::test {
namespace {

constexpr int kTrials = 20000;

class FrameInverse : public testing::Test {
  protected:
    Vec3f draw() { return {normal_(random_), normal_(random_), normal_(random_)}; }
    /// Axes of any length that go in any directions.
    TexelFrame draw_frame() {
        TexelFrame frame;
        for (size_t c = 0; c < 3; ++c) {
            frame.axes[c] = draw();
            frame.lengths[c] = length(frame.axes[c]);
        }
        return frame;
    }
    static float measure_error(const TexelFrame& frame, const Vec3f& tbn, const Vec3f& d) {
        return length(frame.axes[0] * tbn.x + frame.axes[1] * tbn.y + frame.axes[2] * tbn.z - d);
    }

    std::mt19937 random_{1};
    std::normal_distribution<float> normal_;
};

TEST_F(FrameInverse, sound_frames_are_inverted) {
    for (int k = 0; k < kTrials; ++k) {
        TexelFrame frame = draw_frame();
        for (size_t c = 0; c < 3; ++c) { // at most some 25 degrees from a right angle
            Vec3f axis = 0.4f * normalize(frame.axes[c]);
            set_component(axis, int(c), get_component(axis, int(c)) + 1);
            frame.axes[c] = axis * frame.lengths[c];
        }
        const Vec3f d = draw();
        const FrameCoordinates inverse = invert_frame(frame, d);
        EXPECT_LE(inverse.error, 0);
        EXPECT_LT(measure_error(frame, inverse.tbn, d), 1e-5f * length(d));
    }
}

TEST_F(FrameInverse, values_are_bounded_and_their_error_is_told) {
    int damped = 0;
    for (int k = 0; k < kTrials; ++k) {
        TexelFrame frame = draw_frame();
        if (k % 3 == 0) frame.axes[1] = frame.axes[0] + 0.01f * draw();
        if (k % 5 == 0) frame.axes[2] *= 0.001f;
        if (k % 7 == 0) frame.axes[0] = {}, frame.lengths[0] = 0;
        const Vec3f d = draw();
        const FrameCoordinates inverse = invert_frame(frame, d);
        for (size_t c = 0; c < 3; ++c)
            EXPECT_LE(std::fabs(get_component(inverse.tbn, int(c))) * frame.lengths[c],
                      1.0001f * length(d) / float(kLeastStretch));
        EXPECT_NEAR(measure_error(frame, inverse.tbn, d), inverse.error, 1e-4f * length(d));
        damped += inverse.error > 0.01f * length(d);
    }
    EXPECT_GT(damped, kTrials / 3);
}

TEST_F(FrameInverse, damping_sets_in_without_a_step) {
    const auto invert = [](float stretch) {
        const TexelFrame frame{{{{stretch, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {1, 1, 1}};
        return invert_frame(frame, {1, 1, 1}).tbn;
    };
    const float least = float(kLeastStretch);
    EXPECT_NEAR(invert(1.0001f * least).x, invert(0.9999f * least).x, 1e-3f / least);
    EXPECT_NEAR(invert(0.5f * least).x, 0.5f / least, 1e-5f);
    EXPECT_FLOAT_EQ(invert(0).x, 0);
    EXPECT_FLOAT_EQ(invert(0).y, 1);
}

} // namespace
} // namespace relief::test
