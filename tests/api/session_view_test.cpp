// Pictures of a session after its view changed: those of a fresh scene with that camera, bit for bit.
#include <algorithm>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include "relief/error.h"
#include "relief/session.h"
#include "support/session_scenes.h"

namespace relief {
namespace {

using test::make_rough_torus, test::make_session_settings;

/// From afar, near enough for finer levels, and from within the body.
std::vector<Camera> list_cameras(const Scene& scene) {
    std::vector<Camera> cameras;
    for (const Vec3f& from : {Vec3f{4, 3, -2}, Vec3f{0.9f, 1.2f, 0.9f}, Vec3f{1, 0, 0}, Vec3f{2, 2, 1}}) {
        Camera camera = scene.camera;
        camera.from = camera.to + from;
        camera.to = camera.from + (from.y == 0 ? Vec3f{0.1f, 0.1f, 1} : camera.to - camera.from);
        cameras.push_back(camera);
    }
    return cameras;
}

void expect_follows_views(Scene scene, RenderSettings settings) {
    Session session(scene, settings);
    session.render();
    for (const Camera& camera : list_cameras(scene)) {
        session.change_view(camera, settings.image);
        scene.camera = camera;
        ASSERT_TRUE(session.render().image.pixels == render(scene, settings).image.pixels)
            << camera.from.x << ", " << camera.from.y << ", " << camera.from.z;
    }
}

TEST(SessionView, gives_the_pictures_of_a_fresh_scene) {
    expect_follows_views(make_rough_torus(), make_session_settings());
    RenderSettings settings = make_session_settings();
    settings.surface.level = 3;
    expect_follows_views(make_rough_torus(), settings);
    settings.surface.level = kAutoLevel, settings.surface.lod = LodRule::ray;
    expect_follows_views(make_rough_torus(), settings);
}

/// The control cage of the torus: faces that are cut where the view asks for it.
Scene make_smooth_torus(DisplacementSpace space) {
    Scene scene = make_rough_torus();
    scene.meshes[0].subdivision.scheme = SubdivisionScheme::catmark;
    scene.displacements[0].space = space;
    return scene;
}

TEST(SessionView, subdivides_as_the_view_asks_for) {
    for (const auto& [use, filter] :
         {std::pair(SessionUse::views, MapFilter::none), std::pair(SessionUse::edits, MapFilter::mip),
          std::pair(SessionUse::edits, MapFilter::cubic), std::pair(SessionUse::scenes, MapFilter::cubic)}) {
        Scene scene = make_smooth_torus(DisplacementSpace::tangent);
        scene.displacements[0].filter = filter;
        const RenderSettings settings = make_session_settings();
        Session session(scene, settings, use);
        uint64_t fewest = UINT64_MAX, most = 0;
        session.render();
        for (const float distance : {4.0f, 40.0f, 1.6f, 400.0f, 4.0f}) {
            scene.camera.from = scene.camera.to + Vec3f{0.6f, 0.7f, 0.4f} * distance;
            session.change_view(scene.camera, settings.image);
            const RenderResult shown = session.render(), fresh = render(scene, settings);
            ASSERT_TRUE(shown.image.pixels == fresh.image.pixels) << distance;
            EXPECT_EQ(shown.statistics.patches, fresh.statistics.patches) << distance;
            fewest = std::min(fewest, fresh.statistics.patches),
            most = std::max(most, fresh.statistics.patches);
        }
        EXPECT_GT(most, 2 * fewest) << "no view asked for another level";
    }
}

TEST(SessionView, a_preview_may_have_the_geometry_of_the_picture_after_it) {
    const Scene scene = make_smooth_torus(DisplacementSpace::tangent);
    const RenderSettings settings = make_session_settings();
    RenderSettings preview = settings;
    preview.image.width /= 4, preview.image.height /= 4;
    Session without(scene, preview, SessionUse::views);
    without.change_view(scene.camera, settings.image);
    EXPECT_EQ(without.made_surfaces(), 2u) << "another size asks for other patches";
    preview.image.detail_height = settings.image.height;
    Session session(scene, preview, SessionUse::views);
    session.render();
    session.change_view(scene.camera, settings.image);
    EXPECT_EQ(session.made_surfaces(), 1u);
    EXPECT_TRUE(session.render().image.pixels == render(scene, settings).image.pixels);
}

TEST(SessionView, edits_of_a_map_outlive_another_subdivision) {
    Scene scene = make_smooth_torus(DisplacementSpace::tangent);
    const RenderSettings settings = make_session_settings();
    Session session(scene, settings);
    session.render();
    MapEdit edit;
    edit.displacement = scene.displacements[0].name;
    edit.x = 2, edit.y = 3;
    edit.texels = *scene.displacements[0].tiles[0].texture;
    edit.texels.width = edit.texels.height = 1;
    if (edit.texels.halves.empty())
        edit.texels.floats.assign(edit.texels.stride, 0.125f);
    else
        edit.texels.halves.assign(edit.texels.stride, 0x3000);
    session.edit(edit);
    scene.camera.from = scene.camera.to + Vec3f{0.6f, 0.7f, 0.4f} * 1.6f;
    session.change_view(scene.camera, settings.image);
    auto edited = std::make_shared<Texture>(*scene.displacements[0].tiles[0].texture);
    const size_t place = edited->find_texel(2, 3);
    for (size_t c = 0; c < edited->stride; ++c) {
        if (edited->halves.empty())
            edited->floats[place + c] = 0.125f;
        else
            edited->halves[place + c] = 0x3000;
    }
    scene.displacements[0].tiles[0].texture = edited;
    EXPECT_TRUE(session.render().image.pixels == render(scene, settings).image.pixels);
}

TEST(SessionView, chooses_other_copies_of_filtered_maps) {
    Scene scene = make_rough_torus();
    scene.displacements[0].filter = MapFilter::mip;
    RenderSettings settings = make_session_settings();
    settings.surface.pixel_error = 4;
    expect_follows_views(scene, settings);
}

TEST(SessionView, needs_no_engine_that_keeps_its_trees) {
    RenderSettings settings = make_session_settings();
    settings.experiment.structure = StructureKind::kdtree;
    expect_follows_views(make_rough_torus(), settings);
}

TEST(SessionView, follows_far_from_the_origin) {
    const Vec3f place{3e5f, -2e5f, 1e5f};
    Scene scene = make_rough_torus();
    scene.objects[0].world_from_object.translation = place;
    scene.camera.from = scene.camera.from + place, scene.camera.to = scene.camera.to + place;
    Session session(scene, make_session_settings());
    session.render();
    Camera camera = scene.camera;
    camera.from = camera.from + Vec3f{1, 0, 0};
    session.change_view(camera, make_session_settings().image);
    const Image image = session.render().image;
    const size_t alpha = *image.find_channel("A");
    float covered = 0;
    for (size_t k = alpha; k < image.pixels.size(); k += image.channels.size()) covered += image.pixels[k];
    EXPECT_GT(covered, 0.1f * 96 * 72);
    EXPECT_LT(covered, 0.9f * 96 * 72);
}

TEST(SessionView, counts_each_picture_by_itself) {
    Scene scene = make_rough_torus();
    const RenderSettings settings = make_session_settings();
    Session session(scene, settings);
    session.render();
    scene.camera.from = scene.camera.from + Vec3f{0.2f, 0, 0};
    session.change_view(scene.camera, settings.image);
    const Statistics again = session.render().statistics, fresh = render(scene, settings).statistics;
    EXPECT_EQ(again.camera_rays, fresh.camera_rays);
    EXPECT_EQ(again.shadow_rays, fresh.shadow_rays);
    EXPECT_EQ(again.bounce_rays, fresh.bounce_rays);
    EXPECT_GT(again.camera_rays, 0u);
    EXPECT_GT(again.shade_s, 0);
    ASSERT_EQ(again.casts.size(), fresh.casts.size());
    for (size_t k = 0; k < fresh.casts.size(); ++k) EXPECT_EQ(again.casts[k].rays, fresh.casts[k].rays) << k;
}

/// Boxes of vertices, which many rays bring, hold the levels of their view alone.
TEST(SessionView, forgets_boxes_of_coarser_levels) {
    Scene scene = make_rough_torus();
    RenderSettings settings = make_session_settings();
    scene.displacements[0].scale = {8, 8, 8}; // so that much lies outside boxes of the corners
    scene.camera.from = {90, 80, 70};
    settings.image.spp = 64, settings.image.bounces = 0;
    Session session(scene, settings);
    session.render();
    scene.camera.from = {2.4f, 1.9f, 1.2f};
    settings.image.spp = 1;
    session.change_view(scene.camera, settings.image);
    EXPECT_TRUE(session.render().image.pixels == render(scene, settings).image.pixels);
}

TEST(SessionView, takes_another_size_and_edits_after_it) {
    Scene scene = make_rough_torus();
    RenderSettings settings = make_session_settings();
    Session session(scene, settings);
    settings.image.width = 40, settings.image.height = 56, settings.image.bounces = 1;
    session.change_view(scene.camera, settings.image);
    EXPECT_TRUE(session.render().image.pixels == render(scene, settings).image.pixels);
    MapEdit edit;
    edit.displacement = "map", edit.x = 30, edit.y = 20;
    edit.texels.width = 20, edit.texels.height = 12, edit.texels.channel_count = 3;
    edit.texels.floats.assign(size_t(4) * 20 * 12, 0.1f);
    session.edit(edit);
    auto map = std::make_shared<Texture>(*scene.displacements[0].tiles[0].texture);
    for (size_t y = 20; y < 32; ++y)
        std::fill_n(map->floats.begin() + std::ptrdiff_t(4 * (y * 96 + 30)), 4 * 20, 0.1f);
    scene.displacements[0].tiles[0].texture = map;
    EXPECT_TRUE(session.render().image.pixels == render(scene, settings).image.pixels);
}

/// Lines that levels are chosen by are measured once for all views, and again where the map has changed.
TEST(SessionView, chooses_levels_by_the_map_as_it_is) {
    Scene scene = make_rough_torus();
    const RenderSettings settings = make_session_settings();
    Session session(scene, settings);
    const auto turn = [&] {
        scene.camera.from = scene.camera.from + Vec3f{0.3f, 0.1f, -0.2f};
        session.change_view(scene.camera, settings.image);
        return session.render().image.pixels == render(scene, settings).image.pixels;
    };
    EXPECT_TRUE(turn());
    auto map = std::make_shared<Texture>(*scene.displacements[0].tiles[0].texture);
    for (float& value : map->floats) value *= 6;
    MapEdit edit;
    edit.displacement = "map", edit.texels = *map;
    session.edit(edit);
    scene.displacements[0].tiles[0].texture = map;
    EXPECT_TRUE(turn());
}

TEST(SessionView, refuses_what_a_render_refuses_and_stays_as_it_was) {
    const Scene scene = make_rough_torus();
    RenderSettings settings = make_session_settings();
    Session session(scene, settings);
    const Image before = session.render().image;
    Camera camera = scene.camera;
    camera.to = camera.from;
    EXPECT_THROW(session.change_view(camera, settings.image), Error);
    ImageSettings image = settings.image;
    image.width = 0;
    EXPECT_THROW(session.change_view(scene.camera, image), Error);
    image = settings.image, image.layers = {"depth"};
    EXPECT_THROW(session.change_view(scene.camera, image), Error);
    EXPECT_TRUE(session.render().image.pixels == before.pixels);
}

TEST(SessionView, names_the_picture_by_its_camera) {
    Scene scene = make_rough_torus();
    scene.hash = 5;
    RenderSettings settings = make_session_settings();
    Session session(scene, settings);
    const std::string before = session.render().image.metadata.at("relief:scene_hash");
    scene.camera.from.x += 1;
    session.change_view(scene.camera, settings.image);
    EXPECT_NE(session.render().image.metadata.at("relief:scene_hash"), before);
}

} // namespace
} // namespace relief
