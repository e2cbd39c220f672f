// Renders that end early or go on: by noise, by time, from the sums of another render.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <sstream>

#include "relief/error.h"
#include "relief/render.h"
#include "support/session_scenes.h"

namespace relief {

namespace {

Scene make_torus_scene() {
    Scene scene = test::make_rough_torus();
    Light sun;
    sun.type = LightType::sun, sun.direction = {-1, -2, -1};
    scene.lights.push_back(sun);
    return scene;
}

RenderSettings make_kept_settings(int spp) {
    RenderSettings settings;
    settings.image.width = 60, settings.image.height = 44, settings.image.spp = spp,
    settings.image.bounces = 2;
    settings.surface.pixel_error = 3;
    settings.image.layers = {"depth", "N", "samples", "variance"};
    return settings;
}

/// Keeps the last sums that were saved.
struct Keeper {
    std::string bytes;
    int saves = 0;
    Checkpoints checkpoints;
    Keeper() {
        checkpoints.save = [this](const std::function<void(std::ostream&)>& write) {
            std::ostringstream stream;
            write(stream);
            bytes = stream.str(), ++saves;
        };
    }
};

/// Cancels once some progress was made.
class FractionCanceller final : public RenderObserver {
  public:
    explicit FractionCanceller(double fraction) : limit_(fraction) {}
    void on_progress(const Progress& progress) override { fraction_ = progress.fraction; }
    bool is_cancelled() const override { return fraction_ >= limit_; }

  private:
    double limit_;
    std::atomic<double> fraction_{0};
};

RenderResult resume(const std::string& bytes, const RenderSettings& settings, Keeper& keeper) {
    std::istringstream stream(bytes);
    keeper.checkpoints.resume = &stream;
    return render(make_torus_scene(), settings, nullptr, keeper.checkpoints);
}

} // namespace

TEST(Checkpoints, some_samples_then_more_are_the_picture_of_all) {
    const Image whole = render(make_torus_scene(), make_kept_settings(37)).image;
    for (const int first : {1, 5, 16, 36}) {
        Keeper keeper;
        render(make_torus_scene(), make_kept_settings(first), nullptr, keeper.checkpoints);
        RenderSettings settings = make_kept_settings(37);
        settings.device.threads = 1;
        Keeper again;
        const RenderResult result = resume(keeper.bytes, settings, again);
        EXPECT_EQ(result.image.pixels, whole.pixels) << first;
        EXPECT_EQ(result.image.metadata, whole.metadata);
        EXPECT_EQ(result.statistics.camera_rays, uint64_t(60 * 44) * uint64_t(37 - first)) << "none twice";
    }
}

TEST(Checkpoints, a_cancelled_render_goes_on_where_it_ended) {
    for (const float noise : {0.0f, 0.05f}) {
        RenderSettings settings = make_kept_settings(64);
        settings.image.noise = noise;
        const Image whole = render(make_torus_scene(), settings).image;
        Keeper keeper;
        FractionCanceller canceller(0.3);
        const RenderResult part = render(make_torus_scene(), settings, &canceller, keeper.checkpoints);
        EXPECT_FALSE(part.is_complete);
        Keeper again;
        EXPECT_EQ(resume(keeper.bytes, settings, again).image.pixels, whole.pixels) << noise;
    }
}

TEST(Checkpoints, come_while_a_picture_is_traced_and_change_nothing) {
    const Image whole = render(make_torus_scene(), make_kept_settings(20)).image;
    Keeper keeper;
    keeper.checkpoints.interval_s = 1e-9;
    EXPECT_EQ(render(make_torus_scene(), make_kept_settings(20), nullptr, keeper.checkpoints).image.pixels,
              whole.pixels);
    EXPECT_GT(keeper.saves, 20);
}

TEST(Checkpoints, of_another_picture_are_refused) {
    Keeper keeper;
    render(make_torus_scene(), make_kept_settings(1), nullptr, keeper.checkpoints);
    RenderSettings other = make_kept_settings(2);
    other.image.seed = 1;
    Keeper again;
    EXPECT_THROW(resume(keeper.bytes, other, again), Error);
    other = make_kept_settings(2), other.surface.level = 2;
    EXPECT_THROW(resume(keeper.bytes, other, again), Error);
    EXPECT_THROW(resume("relief film", make_kept_settings(2), again), Error);
}

TEST(Checkpoints, of_more_samples_than_asked_for_are_taken_as_they_are) {
    Keeper keeper;
    FractionCanceller canceller(0.3);
    RenderSettings settings = make_kept_settings(64);
    render(make_torus_scene(), settings, &canceller, keeper.checkpoints);
    settings.image.spp = 4;
    Keeper again;
    const RenderResult result = resume(keeper.bytes, settings, again);
    EXPECT_TRUE(result.is_complete);
    EXPECT_GE(result.whole_samples, 4);
    EXPECT_EQ(result.statistics.camera_rays, 0u) << "nothing is lacking";
}

TEST(Checkpoints, a_time_limit_holds_from_the_first_pass_that_goes_on) {
    Keeper keeper;
    render(make_torus_scene(), make_kept_settings(1), nullptr, keeper.checkpoints);
    RenderSettings settings = make_kept_settings(1 << 20);
    settings.image.time_limit_s = 1e-9;
    Keeper again;
    EXPECT_EQ(resume(keeper.bytes, settings, again).statistics.camera_rays, 0u);
}

TEST(Noise, a_limit_spares_samples_and_keeps_the_mean) {
    RenderSettings settings = make_kept_settings(256);
    const Image all = render(make_torus_scene(), settings).image;
    settings.image.noise = 0.1f;
    const RenderResult result = render(make_torus_scene(), settings);
    EXPECT_TRUE(result.is_complete);
    EXPECT_LT(result.statistics.camera_rays, uint64_t(60 * 44) * 200);
    const size_t stride = all.channels.size(), variance = *all.find_channel("variance.G");
    double difference = 0, squares = 0, samples = 0;
    for (size_t p = 0; p < all.pixels.size(); p += stride) {
        difference += result.image.pixels[p + 1] - all.pixels[p + 1];
        squares += result.image.pixels[p + variance];
        samples += result.image.pixels[p + *all.find_channel("samples.Y")];
    }
    EXPECT_EQ(uint64_t(samples), result.statistics.camera_rays) << "the layer says how many there are";
    EXPECT_LT(std::fabs(difference), 4 * std::sqrt(squares)) << "no bias that the sum of all pixels shows";
}

TEST(Noise, the_picture_does_not_depend_on_threads) {
    RenderSettings settings = make_kept_settings(64);
    settings.image.noise = 0.05f;
    settings.device.threads = 1;
    const Image one = render(make_torus_scene(), settings).image;
    settings.device.threads = 2;
    EXPECT_EQ(render(make_torus_scene(), settings).image.pixels, one.pixels);
}

TEST(TimeLimit, ends_a_render_with_one_sample_at_least) {
    RenderSettings settings = make_kept_settings(1 << 20);
    settings.image.time_limit_s = 1e-6;
    const RenderResult result = render(make_torus_scene(), settings);
    EXPECT_TRUE(result.is_complete);
    EXPECT_GE(result.whole_samples, 1);
    EXPECT_LT(result.statistics.camera_rays, uint64_t(60 * 44) * 64);
    EXPECT_TRUE(result.is_out_of_time);
}

TEST(TimeLimit, counts_what_the_caller_does_besides) {
    RenderSettings settings = make_kept_settings(1 << 20);
    settings.image.time_limit_s = settings.image.time_reserved_s = 1000;
    const RenderResult result = render(make_torus_scene(), settings);
    EXPECT_EQ(result.statistics.camera_rays, uint64_t(60 * 44)) << "there is time for the first pass alone";
    EXPECT_EQ(result.whole_samples, 1);
}

TEST(TimeLimit, that_is_not_reached_changes_no_bits) {
    RenderSettings settings = make_kept_settings(20);
    const Image all = render(make_torus_scene(), settings).image;
    settings.image.time_limit_s = 1e6;
    const RenderResult result = render(make_torus_scene(), settings);
    EXPECT_FALSE(result.is_out_of_time);
    EXPECT_EQ(result.image.pixels, all.pixels);
}

TEST(Noise, says_how_many_pixels_reached_it) {
    RenderSettings settings = make_kept_settings(16);
    EXPECT_FALSE(render(make_torus_scene(), settings).noise.has_value()) << "nobody asked";
    settings.image.noise = 1e-6f;
    const RenderResult few = render(make_torus_scene(), settings);
    ASSERT_TRUE(few.noise.has_value());
    EXPECT_EQ(few.noise->pixels, 60u * 44u);
    EXPECT_LT(few.noise->reached_pixels, 60u * 44u);
    EXPECT_GT(few.noise->most, 1e-6);
    settings.image.noise = 1;
    const RenderResult all = render(make_torus_scene(), settings);
    EXPECT_EQ(all.noise->reached_pixels, 60u * 44u);
    EXPECT_EQ(all.noise->most, 0);
}

} // namespace relief
