// Pictures that an observer is shown while a render goes on.
#include <limits>

#include <gtest/gtest.h>

#include "lab/scenes/peer_scenes.h"
#include "relief/session.h"
#include "support/picture_watcher.h"

namespace relief {

namespace {

RenderSettings make_watched_settings() {
    RenderSettings settings;
    settings.image.width = 48, settings.image.height = 32;
    settings.image.spp = 8, settings.image.bounces = 1;
    settings.image.layers = {"samples"};
    return settings;
}

} // namespace

TEST(PicturesSoFar, begin_with_a_sample_of_every_pixel_and_change_nothing) {
    const Scene rock = make_peer_scene("rock", 1, PeerWorld::constant);
    test::PictureWatcher watcher;
    const RenderResult watched = render(rock, make_watched_settings(), &watcher);
    EXPECT_EQ(watched.image.pixels, render(rock, make_watched_settings()).image.pixels);
    ASSERT_GE(watcher.pictures.size(), 3u); // passes end at 1, 4 and 8
    EXPECT_EQ(test::count_samples(watcher.pictures[0]), std::pair(1.0f, 1.0f));
    float least = 0;
    for (const Image& picture : watcher.pictures) {
        EXPECT_EQ(picture.channels, watched.image.channels);
        EXPECT_GT(test::count_samples(picture).first, least);
        EXPECT_EQ(test::count_samples(picture).first, test::count_samples(picture).second)
            << "passes are whole";
        least = test::count_samples(picture).first;
    }
    EXPECT_EQ(watcher.pictures.back().pixels, watched.image.pixels);
}

TEST(PicturesSoFar, come_no_sooner_than_their_interval_but_for_the_first) {
    const Scene rock = make_peer_scene("rock", 1, PeerWorld::constant);
    test::PictureWatcher watcher;
    watcher.interval_s = 1000;
    render(rock, make_watched_settings(), &watcher);
    EXPECT_EQ(watcher.pictures.size(), 1u);
    test::PictureWatcher nobody;
    nobody.interval_s = std::numeric_limits<double>::infinity();
    render(rock, make_watched_settings(), &nobody);
    EXPECT_TRUE(nobody.pictures.empty());
}

TEST(PicturesSoFar, may_end_the_render) {
    const Scene rock = make_peer_scene("rock", 1, PeerWorld::constant);
    test::PictureWatcher watcher;
    watcher.limit = 1;
    RenderSettings settings = make_watched_settings();
    settings.image.spp = 100000;
    const RenderResult result = render(rock, settings, &watcher);
    EXPECT_FALSE(result.is_complete);
    EXPECT_GE(result.whole_samples, 1);
}

TEST(PicturesSoFar, of_a_session_are_those_of_its_pictures) {
    Session session(make_peer_scene("rock", 1, PeerWorld::constant), make_watched_settings());
    test::PictureWatcher watcher;
    const RenderResult first = session.render(&watcher);
    ASSERT_FALSE(watcher.pictures.empty());
    EXPECT_EQ(watcher.pictures.back().pixels, first.image.pixels);
}

} // namespace relief
