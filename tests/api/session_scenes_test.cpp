// A session whose scene goes on in time: its pictures are those of fresh scenes, bit for bit.
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "math/affine.h"
#include "relief/error.h"
#include "relief/session.h"
#include "support/session_scenes.h"

namespace relief {
namespace {

using test::leave_out_meshes, test::make_session_scene, test::make_session_settings;

std::shared_ptr<const Texture> scale_texels(const Texture& texture, float factor) {
    auto other = std::make_shared<Texture>(texture);
    for (float& value : other->floats) value *= factor;
    return other;
}

using Change = std::function<void(Scene&)>;

/// Each change on top of those before, with meshes left out.
void expect_follows(Scene scene, const RenderSettings& settings, const std::vector<Change>& changes) {
    Session session(scene, settings, SessionUse::scenes);
    session.render();
    for (size_t k = 0; k < changes.size(); ++k) {
        changes[k](scene);
        session.change_scene(leave_out_meshes(scene), settings.image);
        EXPECT_TRUE(session.render().image.pixels == render(scene, settings).image.pixels) << "change " << k;
    }
}

void turn(Scene& scene, size_t object, float x) {
    scene.objects[object].world_from_object.rows[0] = {0, 0, x},
    scene.objects[object].world_from_object.rows[2] = {1, 0, 0};
}

const std::vector<Change> kChanges = {
    [](Scene& scene) { scene.objects[1].world_from_object.translation.x = 0.7f; },
    [](Scene& scene) { turn(scene, 0, -1); },
    [](Scene& scene) {
        scene.displacements[0].scale = {1.5f, 1.2f, 2};
    },
    [](Scene& scene) {
        MapTile& tile = scene.displacements[0].tiles[0];
        tile.texture = scale_texels(*tile.texture, 0.5f);
    },
    [](Scene& scene) {
        scene.lights[0].strength = 3, scene.lights[0].direction = {1, -1, 0};
    },
    [](Scene& scene) {
        scene.materials.back().emission = {2, 1, 0};
    },
    [](Scene& scene) {
        scene.environment.emplace(Environment{nullptr, {0.2f, 0.5f, 0.9f}, 2, 30, ""});
    },
    [](Scene& scene) {
        scene.camera.from = scene.camera.from + Vec3f{0.4f, 0.2f, -0.3f};
    },
    [](Scene& scene) { scene.objects[0].world_from_object.rows[1].y = 4; },
};

TEST(SessionScenes, gives_the_pictures_of_fresh_scenes) {
    expect_follows(make_session_scene(), make_session_settings(), kChanges);
}

TEST(SessionScenes, follows_filtered_and_smooth_maps) {
    RenderSettings settings = make_session_settings();
    settings.surface.pixel_error = 4;
    for (const MapFilter filter : {MapFilter::mip, MapFilter::cubic}) {
        Scene scene = make_session_scene();
        scene.displacements[0].filter = filter;
        expect_follows(scene, settings, kChanges);
    }
}

TEST(SessionScenes, follows_surfaces_whose_view_and_map_choose_their_patches) {
    for (const MapFilter filter : {MapFilter::none, MapFilter::cubic, MapFilter::mip}) {
        Scene scene = make_session_scene();
        for (Mesh& mesh : scene.meshes) mesh.subdivision.scheme = SubdivisionScheme::catmark;
        for (Displacement& displacement : scene.displacements) displacement.filter = filter;
        std::vector<Change> changes = kChanges;
        changes.push_back(
            [](Scene& s) { s.camera.from = s.camera.to + (s.camera.from - s.camera.to) * 0.4f; });
        changes.push_back([](Scene& s) { s.displacements[0].scale = {0.01f, 0.01f, 0.01f}; });
        changes.push_back(
            [](Scene& s) { s.camera.from = s.camera.to + (s.camera.from - s.camera.to) * 6.0f; });
        expect_follows(scene, make_session_settings(), changes);
    }
}

TEST(SessionScenes, needs_no_engine_that_follows) {
    RenderSettings settings = make_session_settings();
    settings.experiment.structure = StructureKind::kdtree;
    expect_follows(make_session_scene(), settings, kChanges);
}

TEST(SessionScenes, takes_vectors_in_world_space) {
    Scene scene = make_session_scene();
    scene.displacements[0].space = DisplacementSpace::world;
    expect_follows(scene, make_session_settings(), kChanges);
}

TEST(SessionScenes, replaces_meshes_that_have_changed) {
    Scene scene = make_session_scene();
    const RenderSettings settings = make_session_settings();
    Session session(scene, settings, SessionUse::scenes);
    session.render();
    for (Vec3f& p : scene.meshes[0].positions) p.y *= 1.4f;
    session.change_scene({scene, scene.camera, 7}, settings.image);
    EXPECT_TRUE(session.render().image.pixels == render(scene, settings).image.pixels);
    scene.objects.erase(scene.objects.begin());
    session.change_scene(leave_out_meshes(scene), settings.image);
    EXPECT_TRUE(session.render().image.pixels == render(scene, settings).image.pixels);
}

TEST(SessionScenes, builds_no_tree_again_of_what_moves_as_it_is) {
    Scene scene = make_session_scene();
    RenderSettings settings = make_session_settings();
    settings.surface.level = 3;
    Session session(scene, settings, SessionUse::scenes);
    const uint64_t first = session.render().statistics.bottom_built;
    scene.objects[1].world_from_object.translation.x = 0.05f;
    scene.materials[0].base_color = {0.1f, 0.2f, 0.3f};
    session.change_scene(leave_out_meshes(scene), settings.image);
    EXPECT_LT(session.render().statistics.bottom_built, first / 4);
}

TEST(SessionScenes, refuses_what_it_cannot_follow) {
    const Scene scene = make_session_scene();
    const RenderSettings settings = make_session_settings();
    Session views(scene, settings, SessionUse::views);
    EXPECT_THROW(views.change_scene({scene, scene.camera, 7}, settings.image), Error);
    Session session(scene, settings, SessionUse::scenes);
    MapEdit edit;
    edit.displacement = "map";
    EXPECT_THROW(session.edit(edit), Error);
    SceneUpdate unknown = leave_out_meshes(scene);
    unknown.scene->meshes[0].name = "another";
    EXPECT_THROW(session.change_scene(unknown, settings.image), Error);
    EXPECT_THROW(session.render(), Error) << "it shows no scene";
    session.change_scene(leave_out_meshes(scene), settings.image);
    EXPECT_TRUE(session.render().image.pixels == render(scene, settings).image.pixels);
}

} // namespace
} // namespace relief
