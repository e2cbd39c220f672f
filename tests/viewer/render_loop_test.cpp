// The thread that renders: pictures that refine, follow the camera and edits, and are the renderer's own.
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "common/texel_values.h"
#include "viewer/fixture.h"
#include "viewer/render_loop.h"

namespace relief::viewer {

namespace {

std::shared_ptr<const SharedScene> share_scene(Scene scene) {
    auto shared = std::make_shared<SharedScene>();
    shared->meshes = share_meshes(std::exchange(scene.meshes, {}));
    shared->scene = std::move(scene);
    return shared;
}

RenderRequest make_request(const Scene& scene, Motion motion = Motion::still) {
    RenderRequest request;
    request.scene = share_scene(scene);
    request.scene_version = 1;
    request.settings = make_small_settings();
    request.camera = scene.camera;
    request.motion = motion;
    return request;
}

std::shared_ptr<const ShownPicture> await_complete(RenderLoop& loop, uint64_t version) {
    std::shared_ptr<const ShownPicture> picture;
    wait_until([&] {
        if (auto next = loop.take_picture()) picture = next;
        return picture && picture->is_complete && picture->version == version;
    });
    return picture;
}

MapEdit make_edit() {
    MapEdit edit;
    edit.displacement = "bumps";
    edit.x = edit.y = 20;
    edit.texels.width = edit.texels.height = 12;
    edit.texels.channel_count = 3;
    for (int k = 0; k < 144; ++k) edit.texels.floats.insert(edit.texels.floats.end(), {0, 0, 0.3f, 1});
    return edit;
}

} // namespace

TEST(RenderLoop, the_last_picture_is_that_of_a_render_bit_for_bit) {
    const Scene scene = make_bumpy_scene();
    std::atomic<int> news{0};
    RenderLoop loop([&] { ++news; });
    const auto picture = await_complete(loop, loop.show(make_request(scene)));
    ASSERT_TRUE(picture);
    const Image expected = render(scene, make_small_settings()).image;
    EXPECT_EQ(picture->image.pixels, expected.pixels);
    EXPECT_EQ(picture->image.metadata.at("relief:samples"), expected.metadata.at("relief:samples"));
    EXPECT_EQ(picture->samples, 4);
    EXPECT_GE(news, 2); // one of a small picture, one of the whole
    ASSERT_TRUE(wait_until([&] { return !loop.state().is_busy; }));
    EXPECT_EQ(loop.state().error, "");
    EXPECT_GT(loop.state().statistics->camera_rays, 0u);
}

TEST(RenderLoop, colours_do_not_depend_on_the_layers_of_the_viewer) {
    RenderSettings settings = make_small_settings();
    const Image with = render(make_bumpy_scene(), settings).image;
    settings.image.layers.clear();
    const Image without = render(make_bumpy_scene(), settings).image;
    for (const char* channel : {"R", "G", "B", "A"})
        EXPECT_EQ(get_channel(with, channel), get_channel(without, channel));
}

TEST(RenderLoop, a_moving_camera_gets_small_pictures_of_where_it_is) {
    const Scene scene = make_bumpy_scene();
    RenderLoop loop;
    RenderRequest request = make_request(scene, Motion::moving);
    uint64_t version = 0;
    for (int k = 0; k < 20; ++k) {
        request.camera.from.x = 0.1f * float(k);
        version = loop.show(request);
        std::this_thread::sleep_for(std::chrono::milliseconds(3));
    }
    std::shared_ptr<const ShownPicture> picture;
    ASSERT_TRUE(wait_until([&] {
        if (auto next = loop.take_picture()) picture = next;
        return picture && picture->version == version;
    }));
    EXPECT_FALSE(picture->is_complete);
    EXPECT_LE(picture->image.width, 48);
    EXPECT_EQ(picture->full_width, 48);
    EXPECT_EQ(picture->camera.from, request.camera.from);
    request.motion = Motion::still;
    const auto whole = await_complete(loop, loop.show(request));
    ASSERT_TRUE(whole);
    Scene moved = scene;
    moved.camera = request.camera;
    EXPECT_EQ(whole->image.pixels, render(moved, make_small_settings()).image.pixels);
}

TEST(RenderLoop, edits_are_seen_and_lead_to_the_picture_of_a_fresh_load) {
    Scene scene = make_bumpy_scene();
    RenderLoop loop;
    ASSERT_TRUE(await_complete(loop, loop.show(make_request(scene))));
    const uint64_t version = loop.show(make_request(scene, Motion::painting), {make_edit()});
    std::shared_ptr<const ShownPicture> picture;
    ASSERT_TRUE(wait_until([&] {
        if (auto next = loop.take_picture()) picture = next;
        return picture && picture->version == version;
    }));
    EXPECT_EQ(picture->motion, Motion::painting);
    EXPECT_EQ(picture->image.width, 24);
    EXPECT_EQ(picture->full_width, 48);
    const auto whole = await_complete(loop, loop.show(make_request(scene)));
    ASSERT_TRUE(whole);
    auto texture = std::make_shared<Texture>(*scene.displacements[0].tiles[0].texture);
    for (uint32_t y = 20; y < 32; ++y)
        for (uint32_t x = 20; x < 32; ++x) write_texel(*texture, x, y, {0, 0, 0.3f});
    scene.displacements[0].tiles[0].texture = texture;
    EXPECT_EQ(whole->image.pixels, render(scene, make_small_settings()).image.pixels);
}

TEST(RenderLoop, work_that_nobody_waits_for_ends_at_once) {
    const Scene scene = make_bumpy_scene();
    const auto start = std::chrono::steady_clock::now();
    {
        RenderLoop loop;
        RenderRequest request = make_request(scene);
        request.settings.image.spp = kMaxSamples; // hours
        loop.show(request);
        ASSERT_TRUE(wait_until([&] { return loop.take_picture() != nullptr; }));
        request.settings.image.spp = 2;
        EXPECT_TRUE(await_complete(loop, loop.show(request)));
        request.settings.image.spp = kMaxSamples;
        loop.show(request);
        ASSERT_TRUE(wait_until([&] { return loop.take_picture() != nullptr; }));
    }
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
}

TEST(RenderLoop, errors_are_told_and_the_next_scene_is_rendered) {
    Scene broken = make_bumpy_scene();
    broken.objects[0].mesh = 7;
    RenderLoop loop;
    loop.show(make_request(broken));
    ASSERT_TRUE(wait_until([&] { return !loop.state().error.empty(); }));
    RenderRequest request = make_request(make_bumpy_scene());
    request.scene_version = 2;
    EXPECT_TRUE(await_complete(loop, loop.show(request)));
    EXPECT_EQ(loop.state().error, "");
}

} // namespace relief::viewer
