// Motion blur: the mean of still pictures at the times of its samples, bit for bit.
#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "math/affine.h"
#include "relief/error.h"
#include "relief/session.h"
#include "support/session_scenes.h"

namespace relief {
namespace {

using test::make_rough_torus, test::make_session_settings;

constexpr double kFrame = 12;

/// The body moves, grows its relief and is seen from a camera that moves.
Scene make_moving_scene(double frame) {
    Scene scene = make_rough_torus();
    const float t = float(frame - kFrame);
    scene.meshes[0].name = "torus";
    scene.objects[0].world_from_object.translation = {0.8f * t, 0, 0.3f * t};
    scene.displacements[0].scale = scene.displacements[0].scale * (1 + 0.5f * t);
    scene.camera.from = scene.camera.from + Vec3f{0, 0.6f * t, 0};
    scene.camera.shutter_open = -0.5f, scene.camera.shutter_close = 0.25f;
    scene.hash = 5;
    return scene;
}

/// The same but for the mesh, which stays.
SceneUpdate update_scene(double frame) {
    Scene scene = make_moving_scene(frame);
    const std::string name = scene.meshes[0].name;
    scene.meshes[0] = {};
    scene.meshes[0].name = name;
    const Camera camera = scene.camera;
    return {std::move(scene), camera, 5};
}

RenderSettings make_blur_settings(int samples) {
    RenderSettings settings = make_session_settings();
    settings.image.width = 48, settings.image.height = 36, settings.image.spp = samples;
    settings.image.layers.clear();
    return settings;
}

RenderResult render_blur(const RenderSettings& settings, RenderObserver* observer = nullptr,
                         const Checkpoints& checkpoints = {}) {
    Session session(make_moving_scene(kFrame), settings, SessionUse::scenes);
    return session.render_moving(kFrame, update_scene, observer, checkpoints);
}

/// Sums of single samples, in their order, as a film sums them.
std::vector<float> average_stills(RenderSettings settings) {
    const int first = settings.image.first_sample, samples = settings.image.spp;
    std::vector<double> sums;
    for (int k = first; k < first + samples; ++k) {
        settings.image.first_sample = k, settings.image.spp = 1;
        const Image still =
            render(make_moving_scene(find_sample_time(make_moving_scene(kFrame).camera, kFrame, k)), settings)
                .image;
        sums.resize(still.pixels.size());
        for (size_t p = 0; p < sums.size(); ++p) sums[p] += double(still.pixels[p]);
    }
    std::vector<float> mean;
    for (const double sum : sums) mean.push_back(float(sum / samples));
    return mean;
}

TEST(MotionBlur, spreads_times_evenly_over_the_open_shutter) {
    Camera camera;
    camera.shutter_open = -0.5f, camera.shutter_close = 0.5f;
    EXPECT_EQ(find_sample_time(camera, 3, 0), 3);
    for (const int first : {0, 1, 37, 1000000}) {
        std::set<double> times;
        for (int k = first; k < first + 64; ++k) times.insert(find_sample_time(camera, 3, k));
        ASSERT_EQ(times.size(), 64u);
        EXPECT_GE(*times.begin(), 2.5);
        EXPECT_LT(*times.rbegin(), 3.5);
        double widest = 0, last = 2.5;
        for (const double time : times) widest = std::max(widest, time - last), last = time;
        EXPECT_LT(widest, 2.0 / 64) << "first sample " << first;
    }
}

TEST(MotionBlur, is_the_mean_of_still_pictures) {
    const RenderSettings settings = make_blur_settings(16);
    EXPECT_TRUE(render_blur(settings).image.pixels == average_stills(settings));
    RenderSettings later = make_blur_settings(5);
    later.image.first_sample = 7;
    EXPECT_TRUE(render_blur(later).image.pixels == average_stills(later)) << "any range of samples";
}

TEST(MotionBlur, differs_from_an_instant) {
    const RenderSettings settings = make_blur_settings(8);
    EXPECT_FALSE(render_blur(settings).image.pixels ==
                 render(make_moving_scene(kFrame), settings).image.pixels);
}

TEST(MotionBlur, is_the_same_on_engines_that_follow_nothing) {
    RenderSettings settings = make_blur_settings(3);
    const Image expected = render_blur(settings).image;
    settings.experiment.structure = StructureKind::kdtree;
    const RenderResult other = render_blur(settings);
    EXPECT_TRUE(other.image.pixels == expected.pixels);
    EXPECT_EQ(other.statistics.camera_rays, uint64_t(48) * 36 * 3) << "of all engines together";
}

TEST(MotionBlur, goes_on_from_a_checkpoint) {
    const RenderSettings settings = make_blur_settings(6);
    const Image expected = render_blur(settings).image;
    std::stringstream film;
    Checkpoints writing;
    writing.save = [&](const std::function<void(std::ostream&)>& write) { film.str({}), write(film); };
    RenderSettings part = settings;
    part.image.spp = 2;
    render_blur(part, nullptr, writing);
    Checkpoints reading;
    reading.resume = &film;
    EXPECT_TRUE(render_blur(settings, nullptr, reading).image.pixels == expected.pixels);
}

/// A plane that is carried along with its map, before a camera that stands still, then one that turns.
TEST(MotionBlur, says_how_far_things_move_over_the_picture) {
    RenderSettings settings = make_blur_settings(1);
    settings.image.layers = {"motion"};
    settings.surface.level = 4; // at all times
    const auto render_with = [&](const std::function<void(Scene&, float)>& change) {
        const auto make = [&](double frame) {
            Scene scene = make_moving_scene(kFrame);
            change(scene, float(frame - kFrame));
            return scene;
        };
        Session session(make(kFrame), settings, SessionUse::scenes);
        return session
            .render_moving(kFrame,
                           [&](double frame) {
                               Scene scene = make(frame);
                               const Camera camera = scene.camera;
                               return SceneUpdate{std::move(scene), camera, 5};
                           })
            .image;
    };
    // Up by half the distance of things, in heights of the picture, over 0.75 frames.
    const Scene still = make_moving_scene(kFrame);
    const float distance = length(still.camera.to - still.camera.from);
    const float height = 2 * std::tan(still.camera.fov_degrees * 3.14159265f / 360) * distance;
    const Image turned = render_with([&](Scene& scene, float t) {
        const Vec3f view = normalize(scene.camera.to - scene.camera.from);
        const Vec3f up = cross(normalize(cross(view, scene.camera.up)), view);
        scene.camera.from = scene.camera.from - up * (t * height),
        scene.camera.to = scene.camera.to - up * (t * height);
    });
    const size_t x = turned.find_channel("motion.X").value(), y = turned.find_channel("motion.Y").value();
    int hits = 0;
    for (int row = 0; row < 36; ++row)
        for (int column = 0; column < 48; ++column) {
            EXPECT_NEAR(turned.at(column, row, x), 0, 1e-3f);
            if (std::fabs(turned.at(column, row, y)) < 1e-3f) continue; // the sky is far away
            ++hits;
            EXPECT_LT(turned.at(column, row, y), -0.75f * 36 * 0.6f);
            EXPECT_GT(turned.at(column, row, y), -0.75f * 36 * 2.0f);
        }
    EXPECT_GT(hits, 200);
    EXPECT_LT(hits, 48 * 36 - 200);
    const Image grown = render_with([](Scene& scene, float t) {
        scene.objects[0].world_from_object.rows[0].x = 1 + t; // of the torus about the origin
    });
    float least = 0, greatest = 0;
    for (int column = 0; column < 48; ++column) {
        least = std::min(least, grown.at(column, 18, x)),
        greatest = std::max(greatest, grown.at(column, 18, x));
    }
    EXPECT_LT(least, -1);
    EXPECT_GT(greatest, 1);
}

/// Blocks that come back late have their samples at the times of these: each pixel is that of a picture with
/// as many samples for all.
TEST(MotionBlur, asks_for_samples_by_noise) {
    RenderSettings settings = make_blur_settings(96);
    settings.image.noise = 0.08f;
    settings.image.layers = {"samples"};
    const Image image = render_blur(settings).image;
    const size_t channel = image.find_channel("samples.Y").value(), stride = image.channels.size();
    std::set<int> counts;
    for (size_t k = channel; k < image.pixels.size(); k += stride) counts.insert(int(image.pixels[k]));
    ASSERT_GT(counts.size(), 2u);
    for (const int count : counts) {
        const Image even = render_blur(make_blur_settings(count)).image;
        const size_t even_stride = even.channels.size();
        for (size_t pixel = 0; pixel < image.pixels.size() / stride; ++pixel) {
            if (int(image.pixels[pixel * stride + channel]) != count) continue;
            for (size_t c = 0; c < 3; ++c)
                ASSERT_EQ(image.pixels[pixel * stride + c], even.pixels[pixel * even_stride + c]) << pixel;
        }
    }
}

TEST(MotionBlur, refuses_objects_that_come_or_go_in_one_picture) {
    const auto render_with = [](const std::function<void(Scene&)>& change, const char* layer) {
        RenderSettings settings = make_blur_settings(4);
        settings.image.layers = {layer};
        settings.image.background = Vec3f{};
        Session session(make_moving_scene(kFrame), settings, SessionUse::scenes);
        try {
            session.render_moving(kFrame, [&](double frame) {
                SceneUpdate update = update_scene(frame);
                if (frame > kFrame) change(*update.scene);
                return update;
            });
        } catch (const Error& error) {
            EXPECT_NE(error.where().find("at frame 1"), std::string::npos) << error.where();
            return error.message();
        }
        return std::string();
    };
    const auto add = [](Scene& scene) { scene.objects.push_back(scene.objects[0]); };
    const auto rename = [](Scene& scene) { scene.objects[0].name = "another"; };
    const auto catch_shadows = [](Scene& scene) { scene.objects[0].is_shadow_catcher = true; };
    EXPECT_NE(render_with(add, "depth").find("objects come or go"), std::string::npos);
    EXPECT_NE(render_with(rename, "CryptoObject").find("names or materials"), std::string::npos);
    EXPECT_EQ(render_with(rename, "depth"), "");
    EXPECT_NE(render_with(catch_shadows, "depth").find("shadow catcher"), std::string::npos);
}

TEST(MotionBlur, tells_progress_of_the_whole_and_heeds_an_end) {
    struct Watcher : RenderObserver {
        std::vector<Progress> told;
        int most = 1000;
        void on_progress(const Progress& progress) override { told.push_back(progress); }
        bool is_cancelled() const override { return !told.empty() && told.back().samples_done >= most; }
    };
    Watcher watcher;
    EXPECT_TRUE(render_blur(make_blur_settings(4), &watcher).is_complete);
    ASSERT_FALSE(watcher.told.empty());
    EXPECT_TRUE(std::ranges::is_sorted(watcher.told, {}, &Progress::fraction));
    EXPECT_EQ(watcher.told.back().samples_done, 4);
    EXPECT_EQ(watcher.told.back().samples_total, 4);
    EXPECT_EQ(watcher.told.back().fraction, 1);
    Watcher impatient;
    impatient.most = 2;
    const RenderResult cut = render_blur(make_blur_settings(16), &impatient);
    EXPECT_FALSE(cut.is_complete);
    EXPECT_EQ(cut.whole_samples, 2);
    EXPECT_TRUE(cut.image.pixels == average_stills(make_blur_settings(2)));
}

} // namespace
} // namespace relief
