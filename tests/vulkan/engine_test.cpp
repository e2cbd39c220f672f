// The whole engine on a validated device: pictures, cancellation, rays of other programs, from several
// threads; and what it finds is what the CPU engine finds.
#include <cmath>
#include <iterator>
#include <thread>
#include <vector>

#include "cast_fixture.h"
#include "cpu/cpu_engine.h"
#include "vulkan/vulkan_engine.h"

namespace relief::vulkan::tests {
namespace {

/// Cancels at the n-th query, or after a number of passes.
class Canceller final : public RenderObserver {
  public:
    static constexpr int kNever = 1 << 30;
    explicit Canceller(int queries, int passes = kNever) : queries_(queries), passes_(passes) {}
    void on_progress(const Progress& progress) override { progress_ = progress; }
    bool is_cancelled() const override {
        later_queries_ += is_cancelled_;
        is_cancelled_ = is_cancelled_ || ++query_count_ > queries_ || progress_.samples_done >= passes_;
        return is_cancelled_;
    }
    const Progress& progress() const { return progress_; }
    int query_count() const { return query_count_; }
    int later_queries() const { return later_queries_; }
    bool has_cancelled() const { return is_cancelled_; }

  private:
    int queries_, passes_;
    mutable int query_count_ = 0, later_queries_ = 0;
    mutable bool is_cancelled_ = false;
    Progress progress_;
};

class EngineTest : public testing::Test {
  protected:
    EngineTest() {
        settings_.image.width = 48, settings_.image.height = 32;
        settings_.image.spp = 3, settings_.image.bounces = 2;
        settings_.image.layers = {"depth", "id", "samples"};
    }

    void prepare() {
        prepared_ = prepare_scene(make_scene(DisplacementSpace::tangent), settings_);
        auto device =
            std::make_unique<Device>(Device::Config{.index = get_test_device_index(), .is_validated = true});
        device_ = device.get();
        engine_ = make_engine_on(std::move(device), prepared_, settings_);
    }

    void TearDown() override {
        if (!device_) return;
        for (const std::string& message : device_->validation_messages()) ADD_FAILURE() << message;
    }

    Film make_film() const {
        return {settings_.image.width, settings_.image.height, settings_.image.crop, settings_.image.layers};
    }

    RenderSettings settings_;
    std::shared_ptr<const PreparedScene> prepared_;
    const Device* device_ = nullptr; ///< the engine's
    std::unique_ptr<Engine> engine_;
};

void expect_close(const Image& a, const Image& b, size_t most) {
    ASSERT_EQ(a.pixels.size(), b.pixels.size());
    size_t other = 0;
    for (size_t k = 0; k < a.pixels.size(); ++k) {
        const float x = a.pixels[k], y = b.pixels[k];
        other += !(x == y || std::fabs(x - y) <= 1e-3f * std::max(1.0f, std::fabs(y)));
    }
    EXPECT_LE(other, most);
}

TEST_F(EngineTest, renders_what_the_cpu_engine_renders) {
    settings_.surface.level = 6; // tiles
    prepare();
    Film film = make_film(), expected = make_film();
    EXPECT_TRUE(engine_->render(film, nullptr));
    make_cpu_engine(prepared_, settings_)->render(expected, nullptr);
    expect_close(film.resolve(), expected.resolve(), 8);
    Statistics statistics;
    engine_->add_statistics(statistics);
    EXPECT_EQ(statistics.engine, "vulkan");
    EXPECT_EQ(statistics.camera_rays, 3u * 48 * 32);
    EXPECT_GT(statistics.bottom_built, 0u);
    EXPECT_GE(statistics.pairs_emitted, statistics.pairs_with_hit);
}

TEST_F(EngineTest, shows_pictures_of_whole_passes_and_changes_nothing) {
    prepare();
    Film film = make_film(), alone = make_film();
    std::vector<uint32_t> samples;
    RenderControl control;
    control.show = {0, [&] { samples.push_back(film.least_samples()); }};
    EXPECT_TRUE(engine_->render(film, control));
    EXPECT_EQ(samples, (std::vector<uint32_t>{1, 3}));
    EXPECT_TRUE(engine_->render(alone, nullptr));
    EXPECT_EQ(film.resolve().pixels, alone.resolve().pixels);
}

TEST_F(EngineTest, cancelled_leaves_a_picture_of_whole_passes) {
    prepare();
    Film film = make_film();
    Canceller canceller(Canceller::kNever, 1);
    EXPECT_FALSE(engine_->render(film, &canceller));
    const Image image = film.resolve();
    const size_t samples = image.find_channel("samples.Y").value();
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) ASSERT_EQ(image.at(x, y, samples), 1) << x << "," << y;
    EXPECT_NEAR(canceller.progress().fraction, 1 / 3.0, 1e-6);
    EXPECT_GT(canceller.progress().rays, 0u);
    Film again = make_film();
    EXPECT_TRUE(engine_->render(again, nullptr));
}

/// Every submission and compilation asks beforehand: none comes after the request, which the passes see once
/// more.
TEST_F(EngineTest, cancelled_anywhere_does_nothing_more_and_keeps_whole_samples) {
    settings_.image.layers = {"samples", "P", "N"};
    prepare();
    Film first = make_film(), whole = make_film();
    EXPECT_TRUE(engine_->render(first, nullptr)); // compiles, as no later one does
    Canceller counter(Canceller::kNever);
    EXPECT_TRUE(engine_->render(whole, &counter));
    const Image expected = whole.resolve();
    const int most = counter.query_count();
    EXPECT_GT(most, 40);
    const size_t samples = expected.find_channel("samples.Y").value();
    int cancelled_count = 0, attempts = 0;
    for (int queries = 0; queries < most; queries += 1 + most / 20, ++attempts) {
        Canceller canceller(queries);
        Film film = make_film();
        const bool is_whole = engine_->render(film, &canceller);
        // Parts of launches depend on time: with fewer of them the picture is done before the request comes.
        EXPECT_TRUE(is_whole || canceller.has_cancelled()) << queries << " of " << most;
        cancelled_count += !is_whole;
        EXPECT_LE(canceller.later_queries(), 1)
            << "queries, hence submissions, after the request: " << queries << " of " << most;
        const Image image = film.resolve();
        if (is_whole) EXPECT_EQ(film.least_samples(), 3u) << queries << " of " << most;
        EXPECT_GE(image.at(0, 0, samples), canceller.progress().samples_done);
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                for (size_t c = 0; image.at(x, y, samples) == 3 && c < image.channels.size(); ++c)
                    ASSERT_EQ(image.at(x, y, c), expected.at(x, y, c)) << queries;
    }
    EXPECT_GE(cancelled_count, attempts / 2) << "of " << attempts;
}

TEST_F(EngineTest, answers_rays_as_the_cpu_engine_does_from_several_threads) {
    prepare();
    std::vector<Ray> rays;
    for (const cpu::TraceRay& ray : make_rays(2000, 5))
        rays.push_back({ray.origin, ray.t_min, ray.direction, ray.t_max});
    std::vector<RayHit> expected(rays.size());
    std::vector<uint8_t> expected_any(rays.size());
    const std::unique_ptr<Engine> cpu = make_cpu_engine(prepared_, settings_);
    cpu->closest_hits(rays, expected, kVisibleToAll);
    cpu->any_hits(rays, expected_any, kVisibleToAll);
    std::vector<std::vector<RayHit>> hits(3, std::vector<RayHit>(rays.size()));
    std::vector<std::vector<uint8_t>> any(3, std::vector<uint8_t>(rays.size()));
    std::vector<std::thread> threads;
    for (size_t k = 0; k < hits.size(); ++k)
        threads.emplace_back([&, k] {
            engine_->closest_hits(rays, hits[k], kVisibleToAll);
            engine_->any_hits(rays, any[k], kVisibleToAll);
        });
    for (std::thread& thread : threads) thread.join();
    for (size_t k = 0; k < hits.size(); ++k) {
        EXPECT_EQ(any[k], expected_any);
        for (size_t i = 0; i < rays.size(); ++i) {
            ASSERT_EQ(hits[k][i].object, expected[i].object) << i;
            if (expected[i].object == kNoIndex) continue;
            EXPECT_NEAR(hits[k][i].t, expected[i].t, 1e-5f * expected[i].t) << i;
            EXPECT_EQ(hits[k][i].patch, expected[i].patch) << i;
            EXPECT_LT(length(hits[k][i].normal - expected[i].normal), 1e-3f) << i;
        }
    }
}

TEST_F(EngineTest, renders_beside_other_engines_on_the_same_device) {
    prepare();
    Film alone = make_film();
    engine_->render(alone, nullptr);
    std::vector<Film> films;
    for (int k = 0; k < 3; ++k) films.push_back(make_film());
    std::vector<std::thread> threads;
    for (Film& film : films)
        threads.emplace_back([&] {
            auto device = std::make_unique<Device>(
                Device::Config{.index = get_test_device_index(), .is_validated = true});
            make_engine_on(std::move(device), prepared_, settings_)->render(film, nullptr);
        });
    for (std::thread& thread : threads) thread.join();
    for (const Film& film : films) EXPECT_EQ(film.resolve().pixels, alone.resolve().pixels);
}

TEST_F(EngineTest, rays_with_nan_hit_nothing_and_do_not_affect_others) {
    prepare();
    std::vector<Ray> rays;
    for (const cpu::TraceRay& ray : make_rays(600, 5))
        rays.push_back({ray.origin, ray.t_min, ray.direction, ray.t_max});
    std::vector<RayHit> whole(rays.size()), hits(rays.size());
    engine_->closest_hits(rays, whole, kVisibleToAll);
    for (size_t k = 0; k < rays.size(); k += 7) {
        Ray& ray = rays[k];
        float* const places[] = {&ray.origin.x, &ray.direction.y, &ray.direction.z, &ray.t_min};
        *places[k / 7 % std::size(places)] = k % 2 == 0 ? NAN : INFINITY;
        whole[k] = {};
    }
    std::vector<uint8_t> any(rays.size());
    engine_->closest_hits(rays, hits, kVisibleToAll);
    engine_->any_hits(rays, any, kVisibleToAll);
    for (size_t k = 0; k < rays.size(); ++k) {
        ASSERT_EQ(hits[k].t, whole[k].t) << k;
        ASSERT_EQ(hits[k].object, whole[k].object) << k;
        ASSERT_EQ(any[k] != 0, whole[k].object != kNoIndex) << k;
    }
}

} // namespace
} // namespace relief::vulkan::tests
