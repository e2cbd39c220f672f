// Sessions whose changes are cancelled, fail, or make other lists of meshes.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "relief/error.h"
#include "relief/session.h"
#include "support/session_scenes.h"

namespace relief {
namespace {

using test::leave_out_meshes, test::make_rough_torus, test::make_session_scene, test::make_session_settings;

/// Cancels after `limit` queries.
struct Canceller final : RenderObserver {
    mutable std::atomic<int> looks{0};
    int limit;
    double fraction = -1;
    explicit Canceller(int limit) : limit(limit) {}
    void on_progress(const Progress&) override {}
    void on_preparation(double part) override { fraction = part; }
    bool is_cancelled() const override { return ++looks > limit; }
};

ErrorKind find_kind(const auto& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.kind();
    }
    ADD_FAILURE() << "no error";
    return ErrorKind::usage;
}

void expect_shows(Session& session, const Scene& scene, const RenderSettings& settings) {
    EXPECT_TRUE(session.render().image.pixels == render(scene, settings).image.pixels);
}

/// What is changed of the scene: a mesh, the map, the light, and where objects are.
Scene change_all(Scene scene) {
    for (Vec3f& p : scene.meshes.back().positions) p.y *= 1.3f;
    scene.displacements[0].scale = {1.5f, 1.2f, 2};
    scene.lights[0].strength = 3;
    scene.objects[1].world_from_object.translation.x = 0.7f;
    return scene;
}

Scene make_two_meshes() {
    Scene scene = make_session_scene();
    scene.meshes.push_back(scene.meshes[0]);
    scene.meshes.back().name = "second";
    scene.objects[1].mesh = uint32_t(scene.meshes.size() - 1);
    return scene;
}

/// The second mesh is handed over, the others are as they were.
SceneUpdate make_update(const Scene& scene) {
    SceneUpdate update = leave_out_meshes(scene);
    update.scene->meshes.back() = scene.meshes.back();
    return update;
}

TEST(SessionChanges, goes_on_after_a_change_of_the_scene_that_was_cancelled_anywhere) {
    const Scene scene = make_two_meshes(), changed = change_all(scene);
    RenderSettings settings = make_session_settings();
    settings.image.width = 48, settings.image.height = 36, settings.device.threads = 2;
    Canceller never(1 << 30);
    {
        Session session(scene, settings, SessionUse::scenes);
        session.change_scene(make_update(changed), settings.image, &never);
        EXPECT_EQ(never.fraction, 1);
    }
    ASSERT_GT(never.looks, 20);
    int cancelled = 0;
    for (int limit = 0; limit < never.looks; limit += std::max(1, never.looks / 6)) {
        Session session(scene, settings, SessionUse::scenes);
        session.render();
        Canceller observer(limit);
        try {
            session.change_scene(make_update(changed), settings.image, &observer);
        } catch (const Error& error) {
            ++cancelled;
            EXPECT_EQ(error.kind(), ErrorKind::failed);
            EXPECT_LE(observer.looks, limit + 40) << "work went on";
            session.change_scene(leave_out_meshes(scene), settings.image);
            expect_shows(session, scene, settings);
            session.change_scene(make_update(changed), settings.image);
        }
        expect_shows(session, changed, settings);
    }
    EXPECT_GT(cancelled, 3);
}

TEST(SessionChanges, goes_on_after_a_change_of_the_view_that_was_cancelled) {
    const Scene scene = make_session_scene();
    const RenderSettings settings = make_session_settings();
    Session session(scene, settings, SessionUse::scenes);
    session.render();
    Scene turned = scene;
    turned.camera.from = {-2, 2.5f, 0.4f};
    Canceller at_once(0);
    EXPECT_EQ(find_kind([&] { session.change_view(turned.camera, settings.image, 0, &at_once); }),
              ErrorKind::failed);
    EXPECT_EQ(find_kind([&] { session.render(); }), ErrorKind::usage);
    session.change_view(turned.camera, settings.image);
    expect_shows(session, turned, settings);
}

TEST(SessionChanges, cancels_its_construction) {
    Canceller at_once(0), never(1 << 30);
    const RenderSettings settings = make_session_settings();
    EXPECT_EQ(find_kind([&] { Session(make_session_scene(), settings, SessionUse::scenes, &at_once); }),
              ErrorKind::failed);
    EXPECT_LE(at_once.looks, 4);
    Session(make_session_scene(), settings, SessionUse::scenes, &never);
    EXPECT_EQ(never.fraction, 1);
}

TEST(SessionChanges, goes_on_after_a_scene_with_a_fault) {
    const Scene scene = make_session_scene();
    const RenderSettings settings = make_session_settings();
    Session session(scene, settings, SessionUse::scenes);
    session.render();
    SceneUpdate broken = leave_out_meshes(scene);
    broken.scene->objects[0].world_from_object.translation.x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(find_kind([&] { session.change_scene(broken, settings.image); }), ErrorKind::bad_input);
    SceneUpdate too_long = leave_out_meshes(scene);
    too_long.scene->displacements[0].scale = {1e20f, 1e20f, 1e20f};
    EXPECT_EQ(find_kind([&] { session.change_scene(too_long, settings.image); }), ErrorKind::bad_input);
    session.change_scene(leave_out_meshes(scene), settings.image);
    expect_shows(session, scene, settings);
}

TEST(SessionChanges, makes_the_surfaces_of_changed_meshes_alone) {
    Scene scene = make_two_meshes();
    const RenderSettings settings = make_session_settings();
    Session session(scene, settings, SessionUse::scenes);
    const uint64_t first = session.made_surfaces();
    EXPECT_EQ(first, 3u) << "two displaced meshes, and one of them without";
    scene.camera.from.x += 0.3f;
    session.change_view(scene.camera, settings.image);
    scene.objects[1].world_from_object.translation.x = 0.2f;
    scene.materials[0].base_color = {0.1f, 0.2f, 0.3f};
    session.change_scene(leave_out_meshes(scene), settings.image);
    EXPECT_EQ(session.made_surfaces(), first);
    scene = change_all(scene);
    session.change_scene(make_update(scene), settings.image);
    EXPECT_EQ(session.made_surfaces(), first + 1);
    expect_shows(session, scene, settings);
}

/// Puts a mesh and its displacement before all others, so that each number is another.
void insert_body(Scene& scene) {
    Scene other = make_rough_torus();
    other.meshes[0].name = "new", other.displacements[0].name = "new map";
    for (Vec3f& p : other.meshes[0].positions) p.x *= 0.7f;
    scene.meshes.insert(scene.meshes.begin(), other.meshes[0]);
    scene.displacements.insert(scene.displacements.begin(), other.displacements[0]);
    for (Object& object : scene.objects) {
        ++object.mesh;
        if (object.displacement != kNoIndex) ++object.displacement;
    }
    Object object = scene.objects[0];
    object.mesh = object.displacement = 0, object.world_from_object.translation.z = 0.8f;
    scene.objects.insert(scene.objects.begin(), object);
}

TEST(SessionChanges, keeps_what_has_another_number_than_before) {
    for (const DisplacementSpace space : {DisplacementSpace::tangent, DisplacementSpace::world}) {
        Scene scene = make_two_meshes();
        scene.displacements[0].space = space;
        const RenderSettings settings = make_session_settings();
        Session session(scene, settings, SessionUse::scenes);
        session.render();
        const uint64_t first = session.made_surfaces();
        insert_body(scene);
        SceneUpdate update = leave_out_meshes(scene);
        update.scene->meshes[0] = scene.meshes[0];
        session.change_scene(update, settings.image);
        if (space == DisplacementSpace::tangent) EXPECT_EQ(session.made_surfaces(), first + 1);
        expect_shows(session, scene, settings);
        std::swap(scene.meshes[0], scene.meshes[1]);
        for (Object& object : scene.objects)
            if (object.mesh < 2) object.mesh = 1 - object.mesh;
        session.change_scene(leave_out_meshes(scene), settings.image);
        expect_shows(session, scene, settings);
    }
}

} // namespace
} // namespace relief
